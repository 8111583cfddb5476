#include "io/text_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::io {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

std::unexpected<FileError> failed(int error_number) {
  return std::unexpected(file_error(error_number));
}

/// What is half written goes away again.
std::unexpected<FileError> failed_without(const std::string& new_path, int error_number) {
  std::remove(new_path.c_str());
  return failed(error_number);
}

/// The new name survives a power loss only once its folder is on the disk.
std::expected<void, FileError> sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return failed(errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  // Some file systems cannot; then nobody can do more.
  if (error != 0 && error != EINVAL && error != ENOTSUP) return failed(error);
  return {};
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
  const std::string new_path = path + ".new";
  {
    const File file(std::fopen(new_path.c_str(), "wbe"));
    if (!file) return failed(errno);
    const bool is_written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size() &&
                            std::fflush(file.get()) == 0 && ::fsync(::fileno(file.get())) == 0;
    if (!is_written) return failed_without(new_path, errno);
  }
  if (std::rename(new_path.c_str(), path.c_str()) != 0) return failed_without(new_path, errno);
  return sync_folder_of(path);
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
    case FileFault::Failed: break;
  }
  return "'" + name + "' cannot be used (" + error.system_text + "): check the disk, or copy the file elsewhere.";
}

}  // namespace kerf::io
