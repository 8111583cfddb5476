#include "io/wire_log.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include "common/base/text.hpp"
#include "io/state_folder.hpp"
#include "io/wall_clock.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::io {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// A crash of Kerf itself loses no more than this; the system's own cache is another matter.
constexpr Duration kLongestUnwritten = 1s;
constexpr std::size_t kMostUnwrittenBytes = std::size_t{64} << 10U;
/// Small blocks of one text that repeats itself: a larger window or more effort gains little and costs memory.
constexpr int kLevel = 1;
constexpr int kWindowLog = 18;
constexpr mode_t kOnlyMine = 0600;

/// "/dev/ttyUSB0" becomes "ttyUSB0", "tcp://mill.local:23" "mill.local-23": what a file may be called.
std::string slug_of(std::string_view machine) {
  constexpr std::size_t kLongest = 32;
  machine = machine.substr(0, machine.find('?'));
  machine.remove_prefix(machine.rfind('/') + 1);
  std::string slug;
  for (const char letter : machine.substr(0, kLongest)) {
    const char upper = base::to_upper(letter);
    const bool is_plain = (upper >= 'A' && upper <= 'Z') || base::is_digit(letter) || letter == '.' || letter == '_';
    slug += is_plain ? letter : '-';
  }
  return slug;
}

struct OldPart {
  fs::path path;
  fs::file_time_type written;
  std::uint64_t bytes = 0;
};

/// The logs of a folder, the one written last at the end. What goes away meanwhile is left out.
std::vector<OldPart> parts_in(const std::string& folder) {
  std::vector<OldPart> parts;
  std::error_code fault;
  for (const auto& entry : fs::directory_iterator(folder, fault)) {
    if (!entry.path().native().ends_with(kLogSuffix)) continue;
    OldPart part{.path = entry.path(), .written = entry.last_write_time(fault)};
    if (fault) continue;
    part.bytes = entry.file_size(fault);
    if (!fault) parts.push_back(std::move(part));
  }
  std::ranges::sort(parts, [](const OldPart& left, const OldPart& right) {
    return std::tie(left.written, left.path) < std::tie(right.written, right.path);
  });
  return parts;
}

void remove_oldest(const std::string& folder, const std::string& current, const LogLimits& limits) {
  const auto parts = parts_in(folder);
  std::uint64_t bytes = 0;
  for (const OldPart& part : parts) bytes += part.bytes;
  std::size_t files = parts.size();
  for (const OldPart& part : parts) {
    if (files <= limits.kept_files && bytes <= limits.kept_bytes) return;
    if (part.path == current) continue;
    std::error_code ignored;  // another Kerf may have been quicker
    fs::remove(part.path, ignored);
    --files;
    bytes -= part.bytes;
  }
}

}  // namespace

std::string log_folder() {
  const std::string state = state_folder();
  return state.empty() ? std::string() : (fs::path(state) / "logs").string();
}

std::vector<std::string> list_logs(const std::string& folder) {
  std::vector<std::string> paths;
  for (const OldPart& part : parts_in(folder)) paths.push_back(part.path.string());
  return paths;
}

/// A file that is one zstd frame.
class WireLog::File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor), stream_(ZSTD_createCCtx()) {
    ZSTD_CCtx_setParameter(stream_, ZSTD_c_compressionLevel, kLevel);
    ZSTD_CCtx_setParameter(stream_, ZSTD_c_windowLog, kWindowLog);
    ZSTD_CCtx_setParameter(stream_, ZSTD_c_checksumFlag, 1);
  }
  ~File() {
    ZSTD_freeCCtx(stream_);
    ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// Everything given so far can be read back afterwards. The number of the system's fault, 0 if none.
  int write(std::string_view text, ZSTD_EndDirective how) {
    out_.resize(ZSTD_CStreamOutSize());
    ZSTD_inBuffer in{.src = text.data(), .size = text.size(), .pos = 0};
    for (;;) {
      ZSTD_outBuffer out{.dst = out_.data(), .size = out_.size(), .pos = 0};
      const std::size_t left = ZSTD_compressStream2(stream_, &out, &in, how);
      if (ZSTD_isError(left) != 0U) return ENOMEM;
      if (const int error = write_bytes({out_.data(), out.pos}); error != 0) return error;
      if (left == 0) return 0;
    }
  }

  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  int write_bytes(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return errno;
      if (count == 0) return ENOSPC;
      bytes_ += static_cast<std::uint64_t>(count);
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return 0;
  }

  int descriptor_;
  ZSTD_CCtx* stream_;
  std::string out_;
  std::uint64_t bytes_ = 0;
};

WireLog::WireLog(EventLoop& loop, const RecordingOptions& options, session::LogHeader header, LogLimits limits)
    : loop_(loop), options_(options), header_(std::move(header)), limits_(limits), flush_soon_(loop) {
  is_over_ = !options_.records;
  header_.kerf = KERF_VERSION;
}

WireLog::~WireLog() {
  flush();
  if (file_ && !is_over_) static_cast<void>(file_->write({}, ZSTD_e_end));
}

bool WireLog::is_recording() const {
  return !is_over_;
}

std::optional<std::string> WireLog::take_fault() {
  return std::exchange(fault_, std::nullopt);
}

void WireLog::open_part(Instant at) {
  header_.began = to_string(wall_clock_now());
  if (stem_.empty()) {
    const fs::path folder = options_.folder.empty() ? log_folder() : options_.folder;
    if (folder.empty()) return fail(ENOENT);
    std::error_code fault;
    const bool is_new = fs::create_directories(folder, fault);
    if (fault) return fail(fault.value());
    if (is_new) fs::permissions(folder, fs::perms::owner_all, fault);
    // Colons are no part of a name that has to travel.
    std::string moment = header_.began;
    std::ranges::replace(moment, ':', '-');
    stem_ = (folder / fmt::format("{}-{}-{}", moment, slug_of(header_.machine), ::getpid())).string();
  } else {
    ++header_.part;
  }
  path_ = fmt::format("{}-{:03}{}", stem_, header_.part, kLogSuffix);
  const int descriptor = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kOnlyMine);
  if (descriptor < 0) return fail(errno);
  file_ = std::make_unique<File>(descriptor);
  remove_oldest(fs::path(path_).parent_path().string(), path_, limits_);
  session::append_line(pending_, {.at = at, .what = header_});
}

void WireLog::append(const session::Record& record) {
  if (is_over_) return;
  if (!file_) open_part(record.at);
  if (is_over_) return;
  if (const auto* loaded = std::get_if<session::ProgramLoaded>(&record.what);
      loaded != nullptr && loaded->text.empty()) {
    session::ProgramLoaded named = *loaded;
    std::error_code ignored;
    named.path = fs::absolute(named.name, ignored).string();
    session::append_line(pending_, {.at = record.at, .what = std::move(named)});
  } else {
    session::append_line(pending_, record);
  }
  const bool is_weighty = std::holds_alternative<session::LinkGone>(record.what) ||
                          std::holds_alternative<session::CommandGiven>(record.what);
  if (is_weighty || pending_.size() >= kMostUnwrittenBytes) return flush();
  if (std::exchange(is_armed_, true)) return;
  flush_soon_.arm(loop_.now() + kLongestUnwritten, [this] { flush(); });
}

void WireLog::flush() {
  flush_soon_.disarm();
  is_armed_ = false;
  if (is_over_ || !file_ || pending_.empty()) return;
  const bool is_full = file_->bytes() >= limits_.part_bytes;
  const int error = file_->write(pending_, is_full ? ZSTD_e_end : ZSTD_e_flush);
  pending_.clear();
  if (pending_.capacity() > kMostUnwrittenBytes * 4) pending_.shrink_to_fit();  // there was a program in it
  if (error != 0) return fail(error);
  if (is_full) file_.reset();
}

void WireLog::fail(int error_number) {
  is_over_ = true;
  file_.reset();
  pending_.clear();
  pending_.shrink_to_fit();
  const std::string where = path_.empty() ? (options_.folder.empty() ? log_folder() : options_.folder) : path_;
  fault_ = fmt::format("This connection is not recorded{}: {} ({}). Everything else goes on; {}.",
                       path_.empty() ? "" : " any more", where.empty() ? "there is no home folder" : where,
                       std::generic_category().message(error_number),
                       error_number == ENOSPC ? "make room on the disk" : "name another folder with --record");
}

}  // namespace kerf::io
