#pragma once
// Kerf's decisions once more, from a log: the same inputs at the same instants must give the same bytes.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/describe.hpp>

#include "sender/session/recorded_session.hpp"

namespace kerf::session {

/// Why a replay cannot go on.
enum class ReplayEnd {
  Different,       ///< this Kerf sends other bytes than the one that wrote the log
  NoHeader,        ///< the log does not begin with its header
  MiddlePart,      ///< the log begins in the middle of a connection: the parts before it are needed
  OtherVersion,    ///< a format that this Kerf does not know
  ProgramMissing,  ///< the job's program is not in the log and was not supplied
  ProgramBad,      ///< the log's program is none that Kerf would send
  NotARecord,      ///< a line that is no record
};
BOOST_DESCRIBE_ENUM(ReplayEnd, Different, NoHeader, MiddlePart, OtherVersion, ProgramMissing, ProgramBad, NotARecord)

/// Where and how a replay left the log.
struct ReplayStop {
  ReplayEnd end{};
  /// Number of the record, from 1.
  std::uint64_t record = 0;
  Instant at{};
  BytesSent logged{};
  BytesSent replayed{};
  /// The program's name, where it is about that.
  std::string program{};
};
BOOST_DESCRIBE_STRUCT(ReplayStop, (), (end, record, at, logged, replayed, program))

/// What has been repeated so far.
struct ReplayTally {
  std::uint64_t records = 0;
  std::uint64_t bytes_received = 0;
  std::uint64_t bytes_sent = 0;
  std::uint64_t commands = 0;
};
BOOST_DESCRIBE_STRUCT(ReplayTally, (), (records, bytes_received, bytes_sent, commands))

/// Is fed the records of one log in their order.
class Replay {
 public:
  /// Takes one record; says so when the replay has left the log, and then takes no more.
  [[nodiscard]] std::optional<ReplayStop> feed(const Record& record);

  /// What the session told since the last call.
  [[nodiscard]] std::vector<Event> take_events() { return std::exchange(events_, {}); }
  [[nodiscard]] const ReplayTally& tally() const { return tally_; }
  /// Null before the header.
  [[nodiscard]] const Session* session() const { return session_.get(); }

 private:
  using Stop = std::optional<ReplayStop>;
  Stop follow(Instant at, const LogHeader& header);
  Stop follow(Instant at, const LinkOpened& opened);
  Stop follow(Instant at, const BytesReceived& received);
  Stop follow(Instant at, const BytesSent& sent);
  Stop follow(Instant at, const ProgramLoaded& loaded);
  Stop follow(Instant at, const CommandGiven& given);
  Stop follow(Instant at, const TimePassed& passed);
  Stop follow(Instant at, const LinkGone& gone);
  [[nodiscard]] Stop stop(ReplayEnd end, Instant at, std::string program = {}) const;
  [[nodiscard]] Stop differ(Instant at, const BytesSent& logged) const;
  /// Takes what the input led to.
  void settle();

  std::unique_ptr<RecordedSession> session_;
  std::shared_ptr<const job::Program> program_;
  /// Sent by the replay and not yet found in the log.
  BytesSent owed_;
  std::uint32_t part_ = 0;
  bool listening_ = false;
  std::vector<Event> events_;
  ReplayTally tally_;
};

/// One sentence for people: where, what the log has and what the replay sends, what to do.
[[nodiscard]] std::string sentence_of(const ReplayStop& stop);

/// Replays a whole log as append_line() wrote it. Nothing when all of it was repeated.
[[nodiscard]] std::optional<ReplayStop> replay_text(std::string_view log);

}  // namespace kerf::session
