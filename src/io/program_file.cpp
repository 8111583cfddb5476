#include "io/program_file.hpp"

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <linux/fs.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/state_folder.hpp"
#include "io/unpacking.hpp"

namespace kerf::io {
namespace {

using namespace std::chrono_literals;

/// So much of a mapped file is in memory at once while it is read.
constexpr std::size_t kPieceBytes = std::size_t{4} << 20U;
constexpr auto kGiveBackEvery = 100ms;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

std::unexpected<ProgramFileError> failed(FileError error) {
  return std::unexpected<ProgramFileError>(std::move(error));
}

/// A file without a name where large files may be: /tmp is often memory.
int open_nameless() {
  std::string folder = state_folder();
  if (folder.empty()) folder = "/var/tmp";
  const int opened = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (opened >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return opened;
  std::string name = (std::filesystem::path(folder) / "program-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

/// The system's fault, 0 if none.
int write_all(int to, std::string_view rest) {
  while (!rest.empty()) {
    const ssize_t put = ::write(to, rest.data(), rest.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return put < 0 ? errno : ENOSPC;
    rest.remove_prefix(static_cast<std::size_t>(put));
  }
  return 0;
}

/// With a buffer of our own, for what the kernel cannot copy by itself (a pipe). The system's fault, 0 if none.
int copy_by_hand(int from, int to) {
  std::vector<char> piece(std::size_t{1} << 16U);
  for (;;) {
    const ssize_t got = ::read(from, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) return 0;
    if (const int fault = write_all(to, {piece.data(), static_cast<std::size_t>(got)}); fault != 0) return fault;
  }
}

/// The system's fault, 0 if none.
int copy_file(int from, int to) {
  if (::ioctl(to, FICLONE, from) == 0) return 0;
  constexpr std::size_t kAtOnce = std::size_t{64} << 20U;
  for (;;) {
    const ssize_t count = ::copy_file_range(from, nullptr, to, nullptr, kAtOnce, 0);
    if (count > 0) continue;
    // What is left, if anything, goes by hand: both descriptors stand where this stopped.
    if (count == 0 || errno == EXDEV || errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP || errno == EBADF) {
      return copy_by_hand(from, to);
    }
    if (errno != EINTR) return errno;
  }
}

std::string head_of(int descriptor) {
  std::string head(4, '\0');
  const ssize_t got = ::pread(descriptor, head.data(), head.size(), 0);
  head.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return head;
}

bool is_same_state(const struct stat& before, const struct stat& after) {
  return before.st_size == after.st_size && before.st_mtim.tv_sec == after.st_mtim.tv_sec &&
         before.st_mtim.tv_nsec == after.st_mtim.tv_nsec;
}

}  // namespace

/// A file of ours in the address space.
class ProgramFile::Mapping {
 public:
  Mapping(int descriptor, std::size_t bytes)
      : start_(::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor, 0)), bytes_(bytes) {
    if (!is_good()) return;
    ::madvise(start_, bytes_, MADV_SEQUENTIAL);
    saver_ = std::jthread([this](const std::stop_token& stop) {
      std::mutex mutex;
      std::condition_variable_any stopped;
      std::unique_lock lock(mutex);
      while (!stopped.wait_for(lock, stop, kGiveBackEvery, [&stop] { return stop.stop_requested(); })) give_back();
    });
  }
  ~Mapping() {
    saver_ = {};
    if (is_good()) ::munmap(start_, bytes_);
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  [[nodiscard]] bool is_good() const { return start_ != MAP_FAILED; }
  [[nodiscard]] std::string_view text() const { return {static_cast<const char*>(start_), bytes_}; }
  void give_back() const { ::madvise(start_, bytes_, MADV_DONTNEED); }

 private:
  void* start_;
  std::size_t bytes_;
  std::jthread saver_;
};

std::string explain(const ProgramFileError& error, std::string_view path) {
  if (const auto* fault = std::get_if<job::ProgramFault>(&error)) return job::describe(*fault, path);
  return explain(std::get<FileError>(error), path);
}

std::expected<ProgramFile, ProgramFileError> ProgramFile::load(const std::string& path) {
  return load(path, path);
}

std::expected<ProgramFile, ProgramFileError> ProgramFile::load(const std::string& path, const std::string& name) {
  const Descriptor original(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY));
  struct stat before{};
  if (!original.is_open() || ::fstat(original.get(), &before) != 0) return failed(file_error(errno));
  // What is neither file nor pipe is refused there.
  const bool is_file = S_ISREG(before.st_mode);
  if (!is_file && !S_ISFIFO(before.st_mode)) return read_whole(path, name);
  if (const Packing packing = is_file ? packing_of(head_of(original.get())) : Packing::None; packing != Packing::None)
    return unpacked(name, original.get(), packing);
  if (is_file && std::cmp_less_equal(before.st_size, kMostHeldBytes)) return read_whole(path, name);
  const Descriptor copy(open_nameless());
  if (!copy.is_open()) return failed(file_error(errno));
  if (const int error_number = copy_file(original.get(), copy.get()); error_number != 0) {
    return failed(file_error(error_number));
  }
  struct stat after{};
  if (is_file && (::fstat(original.get(), &after) != 0 || !is_same_state(before, after))) {
    return failed({.fault = FileFault::Changing, .system_text = {}});
  }
  return mapped(name, copy.get());
}

/// A text that comes in pieces: in memory while it is short, then in a file without a name.
class ProgramFile::Assembly {
 public:
  /// The system's fault, 0 if none.
  int put(std::string_view piece) {
    if (copy_) return write_all(copy_->get(), piece);
    text_ += piece;
    if (text_.size() <= kMostHeldBytes) return 0;
    copy_.emplace(open_nameless());
    if (!copy_->is_open()) return errno;
    const int fault = write_all(copy_->get(), text_);
    text_ = {};
    return fault;
  }
  [[nodiscard]] std::expected<ProgramFile, ProgramFileError> finish(const std::string& name) {
    return copy_ ? mapped(name, copy_->get()) : held(name, std::move(text_));
  }

 private:
  std::string text_;
  std::optional<Descriptor> copy_;
};

std::expected<ProgramFile, ProgramFileError> ProgramFile::unpacked(const std::string& name, int packed,
                                                                   Packing packing) {
  Assembly assembly;
  const auto done = unpack(packed, packing, [&assembly](std::string_view piece) { return assembly.put(piece); });
  if (!done) return failed(done.error());
  return assembly.finish(name);
}

std::expected<ProgramFile, ProgramFileError> ProgramFile::assemble(const std::string& name,
                                                                   const std::function<void(const Put&)>& write) {
  Assembly assembly;
  int fault = 0;
  write([&](std::string_view piece) {
    if (fault == 0) fault = assembly.put(piece);
  });
  if (fault != 0) return failed(file_error(fault));
  return assembly.finish(name);
}

std::expected<ProgramFile, ProgramFileError> ProgramFile::read_whole(const std::string& path, const std::string& name) {
  auto text = read_text_file(path);
  if (!text) return failed(std::move(text.error()));
  return held(name, *std::move(text));
}

std::expected<ProgramFile, ProgramFileError> ProgramFile::held(const std::string& name, std::string text) {
  auto program = job::Program::load(name, std::move(text));
  if (!program) return std::unexpected<ProgramFileError>(std::move(program.error()));
  ProgramFile file;
  file.program_ = *std::move(program);
  return file;
}

std::expected<ProgramFile, ProgramFileError> ProgramFile::mapped(const std::string& name, int copy) {
  struct stat copied{};
  if (::fstat(copy, &copied) != 0) return failed(file_error(errno));
  if (copied.st_size == 0) return std::unexpected<ProgramFileError>(job::ProgramFault{});
  const auto mapping = std::make_shared<const Mapping>(copy, static_cast<std::size_t>(copied.st_size));
  if (!mapping->is_good()) return failed(file_error(errno));
  job::ProgramReader reader(name, mapping, mapping->text());
  while (reader.read_on(kPieceBytes)) mapping->give_back();
  auto program = reader.finish();
  if (!program) return std::unexpected<ProgramFileError>(std::move(program.error()));
  ProgramFile file;
  file.mapping_ = mapping;
  file.program_ = *std::move(program);
  return file;
}

void ProgramFile::give_back() const {
  if (mapping_) mapping_->give_back();
}

}  // namespace kerf::io
