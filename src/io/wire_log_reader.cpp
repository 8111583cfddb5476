#include "io/wire_log_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <zstd.h>

#include "common/base/text.hpp"
#include "io/wire_log.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::io {
namespace {

namespace fs = std::filesystem;

/// Of every zstd frame, little endian.
constexpr std::string_view kMagic = "\x28\xB5\x2F\xFD";
/// A line holds a program at most, with every byte escaped; what is longer is no log.
constexpr std::size_t kLongestLine = 8 * session::kMostEmbeddedBytes;
constexpr std::size_t kDigits = 3;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct StreamCloser {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

}  // namespace

struct WireLogReader::State {
  std::unique_ptr<std::FILE, FileCloser> file;
  std::unique_ptr<ZSTD_DStream, StreamCloser> stream;  // null for plain text
  std::string packed;
  std::size_t packed_at = 0;
  std::string text;
  std::size_t text_at = 0;
  std::uint64_t line = 0;
  bool frame_is_open = false;
  bool is_over = false;
  std::string remark;

  void stop(std::string why) {
    if (!is_over) remark = std::move(why);
    is_over = true;
  }

  /// More packed bytes; false at the end of the file.
  bool fill() {
    packed.resize(ZSTD_DStreamInSize());
    packed.resize(std::fread(packed.data(), 1, packed.size(), file.get()));
    packed_at = 0;
    return !packed.empty();
  }

  /// More text; false when there is none.
  bool read_more() {
    text.erase(0, text_at);
    text_at = 0;
    if (packed_at == packed.size() && !fill()) {
      if (frame_is_open) stop("The log ends in the middle, as after a power loss, or is still being written");
      return false;
    }
    if (!stream) {
      text += packed;
      packed_at = packed.size();
      return true;
    }
    const std::size_t before = text.size();
    text.resize(before + ZSTD_DStreamOutSize());
    ZSTD_inBuffer in{.src = packed.data(), .size = packed.size(), .pos = packed_at};
    ZSTD_outBuffer out{.dst = text.data(), .size = text.size(), .pos = before};
    const std::size_t left = ZSTD_decompressStream(stream.get(), &out, &in);
    packed_at = in.pos;
    text.resize(out.pos);
    if (ZSTD_isError(left) != 0U) {
      stop(fmt::format("The log is damaged ({})", ZSTD_getErrorName(left)));
      return text.size() > before;
    }
    frame_is_open = left != 0;
    return true;
  }

  /// The next line without its end.
  std::optional<std::string_view> next_line() {
    std::size_t searched = text_at;
    for (;;) {
      const std::size_t end = text.find('\n', searched);
      if (end != std::string::npos) {
        const std::string_view found = std::string_view(text).substr(text_at, end - text_at);
        text_at = end + 1;
        ++line;
        return found;
      }
      searched = text.size() - text_at;  // read_more() moves the rest to the front
      if (searched > kLongestLine) {
        stop(fmt::format("Line {} is too long for a log", line + 1));
        return std::nullopt;
      }
      if (!is_over && read_more()) continue;
      if (text_at < text.size()) stop("The log ends in the middle of a record");
      return std::nullopt;
    }
  }
};

WireLogReader::WireLogReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
WireLogReader::WireLogReader(WireLogReader&&) noexcept = default;
WireLogReader& WireLogReader::operator=(WireLogReader&&) noexcept = default;
WireLogReader::~WireLogReader() = default;

std::expected<WireLogReader, FileError> WireLogReader::open(const std::string& path) {
  auto state = std::make_unique<State>();
  state->file.reset(std::fopen(path.c_str(), "rbe"));
  struct stat status{};
  if (!state->file || ::fstat(::fileno(state->file.get()), &status) != 0) return std::unexpected(file_error(errno));
  if (S_ISDIR(status.st_mode)) return std::unexpected(file_error(EISDIR));
  static_cast<void>(state->fill());
  if (std::string_view(state->packed).starts_with(kMagic)) state->stream.reset(ZSTD_createDStream());
  return WireLogReader(std::move(state));
}

std::optional<session::Record> WireLogReader::next() {
  while (const auto line = state_->next_line()) {
    auto record = session::parse_record(*line);
    if (record) return *std::move(record);
    switch (record.error()) {
      case session::RecordFault::UnknownKind:
        state_->stop(
            fmt::format("Line {} is of a kind that this Kerf does not know: a newer one wrote the log", state_->line));
        break;
      default: state_->stop(fmt::format("Line {} is no record of a wire log", state_->line)); break;
    }
    return std::nullopt;
  }
  return std::nullopt;
}

const std::string& WireLogReader::remark() const {
  return state_->remark;
}

std::vector<std::string> parts_of(const std::string& path, bool from_the_beginning) {
  const std::size_t tail = kDigits + kLogSuffix.size();
  const std::string_view name(path);
  const auto number = name.ends_with(kLogSuffix) && name.size() > tail
                          ? base::parse_int<unsigned>(name.substr(name.size() - tail, kDigits))
                          : std::nullopt;
  if (!number) return {path};
  const auto part = [&](unsigned index) {
    return fmt::format("{}{:03}{}", name.substr(0, name.size() - tail), index, kLogSuffix);
  };
  std::error_code fault;
  unsigned first = *number;
  while (from_the_beginning && first > 1 && fs::exists(part(first - 1), fault)) --first;
  std::vector<std::string> parts;
  for (unsigned index = first; index <= *number || fs::exists(part(index), fault); ++index)
    parts.push_back(part(index));
  return parts;
}

std::string find_log(const std::string& name, const std::string& folder) {
  std::error_code fault;
  if (name == "latest") {
    const auto logs = list_logs(folder);
    return logs.empty() ? std::string() : logs.back();
  }
  if (!fs::exists(name, fault) && fs::exists(fs::path(folder) / name, fault)) return (fs::path(folder) / name).string();
  return name;
}

}  // namespace kerf::io
