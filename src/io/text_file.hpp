#pragma once
// Whole files of text, read and written at once. Any thread.

#include <expected>
#include <string>
#include <string_view>

namespace kerf::io {

enum class FileFault { NotFound, NoPermission, IsDirectory, NotAFile, NoRoom, Changing, Damaged, TooLarge, Failed };

struct FileError {
  FileFault fault{};
  std::string system_text;
};

[[nodiscard]] std::expected<std::string, FileError> read_text_file(const std::string& path);

/// Writes a new file beside `path` and renames it, so that a reader or a crash sees the old text or the new one.
[[nodiscard]] std::expected<void, FileError> replace_text_file(const std::string& path, std::string_view text);

/// The fault behind a system's error number.
[[nodiscard]] FileError file_error(int error_number);

/// One sentence for people: what, where, what to do.
[[nodiscard]] std::string explain(const FileError& error, std::string_view path);

}  // namespace kerf::io
