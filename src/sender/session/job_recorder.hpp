#pragma once
// Makes the journal of the jobs of one session (job/journal.hpp): from what the session tells, and from what it knows.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/time.hpp"
#include "common/protocol/secrets.hpp"
#include "sender/job/journal.hpp"
#include "sender/session/session.hpp"

namespace kerf::session {

/// Told of every input and what came of it. How far a job is, is written down whenever that changed, but 40 ms apart at
/// least: an SD card must live long. Everything else is written down at once.
class JobRecorder {
 public:
  /// Before the session is told.
  void on_command(Instant now, const Command& command);
  void on_link_closed(Instant now, LinkLoss loss);
  /// After it: `events` came of it.
  void on_events(Instant now, std::span<const Event> events, const Session& session, const protocol::Secrets& secrets);

  [[nodiscard]] Instant next_deadline() const;
  /// Records since the last call.
  [[nodiscard]] std::vector<job::JournalRecord> take_records() { return std::exchange(records_, {}); }

 private:
  /// What the account needs from one event of a job under way.
  class Listener;

  void begin(Instant now, const Session& session, const protocol::Secrets& secrets);
  void write_down(Instant now, job::JournalRecord::What what);
  void note(Instant now, job::NoteKind kind, std::uint32_t line, std::string text);
  void follow_phase(Instant now, const job::JobState& state);
  void follow_tool(Instant now, const machine::Snapshot& snapshot);
  void advance(Instant now, const Session& session, bool at_once);
  void close(Instant now, const job::JobState& state, const Session& session);

  /// The StartJob that may become a job.
  StartJob start_;
  std::uint32_t job_ = 0;
  bool is_open_ = false;
  bool is_off_path_ = false;
  /// As written down last, and what has happened since.
  job::JobAdvanced written_;
  Instant written_at_{};
  job::JobAdvanced current_;
  bool is_due_ = false;
  std::vector<job::JournalRecord> records_;
};

}  // namespace kerf::session
