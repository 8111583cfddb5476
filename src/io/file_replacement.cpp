#include "io/file_replacement.hpp"

#include <cerrno>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace kerf::io {
namespace {

std::unexpected<FileError> failed(int error_number) {
  return std::unexpected(file_error(error_number));
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

std::expected<FileReplacement, FileError> FileReplacement::begin(const std::string& path) {
  FileReplacement replacement(path, nullptr);
  replacement.file_.reset(std::fopen(replacement.new_path().c_str(), "wbe"));
  if (!replacement.file_) return failed(errno);
  return replacement;
}

FileReplacement::~FileReplacement() {
  if (file_) std::remove(new_path().c_str());
}

std::expected<void, FileError> FileReplacement::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) return failed(errno);
  return {};
}

std::expected<void, FileError> FileReplacement::commit() {
  if (std::fflush(file_.get()) != 0 || ::fsync(::fileno(file_.get())) != 0) return failed(errno);
  if (std::rename(new_path().c_str(), path_.c_str()) != 0) return failed(errno);
  file_.reset();
  return sync_folder_of(path_);
}

}  // namespace kerf::io
