#pragma once
// A file that is written piece by piece and takes the place of an older one only when it is whole. Any thread.

#include <cstdio>
#include <expected>
#include <memory>
#include <string>
#include <string_view>

#include "io/text_file.hpp"

namespace kerf::io {

/// What is not committed goes away again.
class FileReplacement {
 public:
  [[nodiscard]] static std::expected<FileReplacement, FileError> begin(const std::string& path);
  FileReplacement(FileReplacement&&) noexcept = default;
  FileReplacement& operator=(FileReplacement&&) = delete;
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;
  ~FileReplacement();

  [[nodiscard]] std::expected<void, FileError> write(std::string_view text);
  /// On the disk, under its name.
  [[nodiscard]] std::expected<void, FileError> commit();

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  FileReplacement(std::string path, std::FILE* file) : path_(std::move(path)), file_(file) {}
  [[nodiscard]] std::string new_path() const { return path_ + ".new"; }

  std::string path_;
  std::unique_ptr<std::FILE, FileCloser> file_;
};

}  // namespace kerf::io
