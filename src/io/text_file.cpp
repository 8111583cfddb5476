#include "io/text_file.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "io/file_replacement.hpp"

namespace kerf::io {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

std::unexpected<FileError> failed(int error_number) {
  return std::unexpected(file_error(error_number));
}

}  // namespace

FileError file_error(int error_number) {
  FileFault fault = FileFault::Failed;
  if (error_number == ENOENT || error_number == ENOTDIR) fault = FileFault::NotFound;
  if (error_number == EACCES || error_number == EPERM || error_number == EROFS) fault = FileFault::NoPermission;
  if (error_number == EISDIR) fault = FileFault::IsDirectory;
  if (error_number == ENOSPC || error_number == EDQUOT) fault = FileFault::NoRoom;
  return {.fault = fault, .system_text = std::generic_category().message(error_number)};
}

std::expected<std::string, FileError> read_text_file(const std::string& path) {
  const File file(std::fopen(path.c_str(), "rbe"));
  if (!file) return failed(errno);
  struct stat status{};
  if (::fstat(::fileno(file.get()), &status) != 0) return failed(errno);
  if (S_ISDIR(status.st_mode)) return failed(EISDIR);
  // A pipe is fine (`<(…)`), a disk or a terminal would never end.
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) {
    return std::unexpected(FileError{.fault = FileFault::NotAFile, .system_text = {}});
  }
  std::string text;
  if (status.st_size > 0) text.reserve(static_cast<std::size_t>(status.st_size));
  char piece[65536];
  for (std::size_t count = sizeof piece; count == sizeof piece;) {
    count = std::fread(piece, 1, sizeof piece, file.get());
    text.append(piece, count);
  }
  if (std::ferror(file.get()) != 0) return failed(errno);
  return text;
}

std::expected<void, FileError> replace_text_file(const std::string& path, std::string_view text) {
  auto file = FileReplacement::begin(path);
  if (!file) return std::unexpected(std::move(file.error()));
  if (auto written = file->write(text); !written) return written;
  return file->commit();
}

std::string explain(const FileError& error, std::string_view path) {
  const std::string name(path);
  switch (error.fault) {
    case FileFault::NotFound: return "There is no file '" + name + "': check the name and the folder.";
    case FileFault::NoPermission:
      return "You may not use '" + name + "': change its permissions, or copy it elsewhere.";
    case FileFault::IsDirectory: return "'" + name + "' is a folder: name a file in it.";
    case FileFault::NotAFile: return "'" + name + "' is a device, not a file: name a file.";
    case FileFault::NoRoom: return "The disk has no room for '" + name + "': make room, then try again.";
    case FileFault::Changing:
      return "'" + name + "' is being written to: wait until the program that makes it has finished, then try again.";
    case FileFault::Damaged:
      return "'" + name + "' is a packed file (gzip or zstd) and damaged or cut short: get it again.";
    case FileFault::TooLarge:
      return "'" + name + "' unpacks to more than 16 GB, which no program needs: choose another file.";
    case FileFault::Failed: break;
  }
  return "'" + name + "' cannot be used (" + error.system_text + "): check the disk, or copy the file elsewhere.";
}

}  // namespace kerf::io
