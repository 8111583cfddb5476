#pragma once
// The flight recorder's files: every connection is written down, compressed and cut into parts, and old parts go. The
// format is docs/wire_log.md.
//
// Loop's thread only. Nothing here waits for the disk (no fsync), and whatever the disk does, the connection goes on:
// the first fault is told once, and then nothing more is written.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/event_loop.hpp"
#include "io/recording_options.hpp"
#include "sender/session/record.hpp"

namespace kerf::io {

/// Limits of a folder of logs.
struct LogLimits {
  std::uint64_t part_bytes = std::uint64_t{4} << 20U;    ///< a part is closed when it has so many, compressed
  std::uint64_t kept_bytes = std::uint64_t{256} << 20U;  ///< the oldest parts go until all others fit
  std::size_t kept_files = 1000;
};

inline constexpr std::string_view kLogSuffix = ".jsonl.zst";

/// $XDG_STATE_HOME/kerf/logs, or ~/.local/state/kerf/logs; empty without a home.
[[nodiscard]] std::string log_folder();

/// The parts in `folder`, the one written last at the end.
[[nodiscard]] std::vector<std::string> list_logs(const std::string& folder);

/// Writes one connection down. The file appears with the first record.
class WireLog {
 public:
  /// `header` needs machine, options and listening; the rest is filled in.
  WireLog(EventLoop& loop, const RecordingOptions& options, session::LogHeader header, LogLimits limits = {});
  ~WireLog();
  WireLog(const WireLog&) = delete;
  WireLog& operator=(const WireLog&) = delete;

  void append(const session::Record& record);
  /// Writing goes on, or has not begun yet.
  [[nodiscard]] bool is_recording() const;
  /// Why this connection is not recorded (any more), in one sentence; once.
  [[nodiscard]] std::optional<std::string> take_fault();
  /// The part being written; empty before the first record.
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  class File;
  void open_part(Instant at);
  void flush();
  void fail(int error_number);

  EventLoop& loop_;
  const RecordingOptions options_;
  session::LogHeader header_;
  const LogLimits limits_;
  Timer flush_soon_;
  bool is_armed_ = false;
  /// Where the parts are and how they are called, without their number.
  std::string stem_;
  std::string path_;
  std::string pending_;
  std::unique_ptr<File> file_;
  std::optional<std::string> fault_;
  bool is_over_ = false;
};

}  // namespace kerf::io
