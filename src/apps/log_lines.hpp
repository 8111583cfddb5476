#pragma once
// A wire log as people read it: one line for each line that was said, and for everything else that happened.

#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "io/wall_clock.hpp"
#include "sender/session/record.hpp"

namespace kerf::apps {

enum class LogDirection { None, Sent, Received };
BOOST_DESCRIBE_ENUM(LogDirection, None, Sent, Received)

/// One line of `kerf log show`; its members are the keys of `--json`.
struct LogEntry {
  Instant at{};
  std::string clock;
  LogDirection direction{};
  /// Of what was received: the message, such as "status_report", "ok". Else "line", "realtime", or the record's kind.
  std::string kind;
  std::string text;
};
BOOST_DESCRIBE_STRUCT(LogEntry, (), (at, clock, direction, kind, text))

/// Turns records into entries: bytes become lines again, at the instant of their last byte.
class LogLines {
 public:
  [[nodiscard]] std::vector<LogEntry> read(const session::Record& record);
  /// What was never finished.
  [[nodiscard]] std::vector<LogEntry> finish();

 private:
  void read_what(Instant at, const session::LogHeader& header);
  void read_what(Instant at, const session::LinkOpened& opened);
  void read_what(Instant at, const session::BytesReceived& received);
  void read_what(Instant at, const session::BytesSent& sent);
  void read_what(Instant at, const session::ProgramLoaded& loaded);
  void read_what(Instant at, const session::CommandGiven& given);
  void read_what(Instant at, const session::TimePassed& passed);
  void read_what(Instant at, const session::LinkGone& gone);
  void add(Instant at, LogDirection direction, std::string kind, std::string text);

  Instant began_at_{};
  std::optional<io::WallClock> began_;
  Instant last_{};
  protocol::MessageReader reader_;
  std::vector<LogEntry> entries_;
};

/// Which entries to show.
struct LogFilter {
  LogDirection direction = LogDirection::None;  ///< None: all
  std::vector<std::string> kinds{};             ///< beginnings of kinds; none: all but "time"
  std::vector<std::string> hidden{};            ///< beginnings of kinds
  std::string since{};                          ///< seconds as shown, or a wall clock; compared as text was given
  std::string until;
  std::optional<std::regex> pattern{};  ///< somewhere in the text
};

/// A moment as people give it: seconds of the log, `13:05` or `13:05:01` of a day, or date and time, UTC.
[[nodiscard]] bool is_moment(std::string_view text);

[[nodiscard]] bool passes(const LogFilter& filter, const LogEntry& entry);

/// "   12.345678 <  ok": instant (or wall clock), direction, text.
[[nodiscard]] std::string shown(const LogEntry& entry, bool by_clock);

}  // namespace kerf::apps
