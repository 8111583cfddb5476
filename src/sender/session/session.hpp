#pragma once
// A conversation with one controller, from opening the link to closing it. Sans I/O: bytes, commands and the time go
// in, an outbox and the next deadline come out. The session is a switchboard; the parts it holds decide.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "common/protocol/message_reader.hpp"
#include "sender/job/job.hpp"
#include "sender/job/job_state.hpp"
#include "sender/job/journal.hpp"
#include "sender/job/link_doubt.hpp"
#include "sender/job/path_watch.hpp"
#include "sender/job/stop_sequence.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/handshake.hpp"
#include "sender/machine/machine_model.hpp"
#include "sender/machine/snapshot.hpp"
#include "sender/session/command.hpp"
#include "sender/session/event.hpp"
#include "sender/session/incidents.hpp"
#include "sender/session/job_feed.hpp"
#include "sender/session/line_gate.hpp"
#include "sender/session/pendant_watch.hpp"
#include "sender/session/settings_change.hpp"
#include "sender/session/state_refresh.hpp"
#include "sender/session/status_poller.hpp"
#include "sender/session/tool_work.hpp"
#include "sender/streaming/streamer.hpp"
#include "sender/streaming/window.hpp"

namespace kerf::session {

using machine::ResetPolicy;

struct SessionOptions {
  /// What the host knows about the link.
  streaming::LinkPace link{};
  ResetPolicy reset_policy = ResetPolicy::WhenAtRest;
  /// Ask for the enumerations (`$EA` …) where the controller has them; `false` makes connecting faster.
  bool enumerate = true;
  /// Have the controller report by itself where it is set up to (grblHAL `$481`); else it is asked.
  bool automatic_reports = true;
  /// Seconds of the machine's clock in one of ours: that of a virtual machine may run faster.
  double machine_clock = 1.0;
};
// Complete, because a log that lacks an option cannot be replayed.
BOOST_DESCRIBE_STRUCT(SessionOptions, (), (link, reset_policy, enumerate, automatic_reports, machine_clock))

/// Why the link went away.
enum class LinkLoss {
  Closed,  ///< by the other end
  Unplugged,
  TimedOut,
  Error,
  HungUp,  ///< Kerf itself ended the connection
};
BOOST_DESCRIBE_ENUM(LinkLoss, Closed, Unplugged, TimedOut, Error, HungUp)

/// Where the conversation stands.
enum class SessionPhase { Closed, Connecting, Waiting, Ready, Failed };
BOOST_DESCRIBE_ENUM(SessionPhase, Closed, Connecting, Waiting, Ready, Failed)

/// What has to leave the session. Realtime bytes must reach the wire before the lines.
struct Outbox {
  std::string realtime;
  std::string lines;
  std::vector<Event> events;
  /// For the journal, in order. Only a RecordedSession makes them.
  std::vector<job::JournalRecord> journal;
  [[nodiscard]] bool empty() const { return realtime.empty() && lines.empty() && events.empty() && journal.empty(); }
};

/// One owner calls in, then empties the outbox. Not thread-safe. Never throws on anything that a wire or an operator
/// can do.
class Session {
 public:
  explicit Session(SessionOptions options = {});

  void on_open(Instant now, const machine::LinkOpening& opening = {});
  void on_bytes(Instant now, std::string_view bytes);
  /// As on_bytes(), in two steps: first the lines for which answers of a running job make room, to be written at once;
  /// what the answers mean is worked out by the next call of anything that is not const, take_outbox() as a rule.
  [[nodiscard]] std::string feed_ahead(Instant now, std::string_view bytes);
  void on_closed(Instant now, LinkLoss loss);
  void submit(Instant now, const Command& command);
  void advance_to(Instant now);
  /// When the session next needs `advance_to`; kNever when it only waits for bytes.
  [[nodiscard]] Instant next_deadline() const;
  [[nodiscard]] Outbox take_outbox();

  [[nodiscard]] SessionPhase phase() const;
  [[nodiscard]] const machine::Snapshot& snapshot() const { return model_.snapshot(); }
  [[nodiscard]] const machine::Capabilities& capabilities() const { return handshake_.capabilities(); }
  /// How the link answers right now.
  [[nodiscard]] LinkHealth link_health(Instant now) const;
  /// Why the machine is in alarm; empty while it is not.
  [[nodiscard]] std::optional<machine::Explanation> alarm_explanation() const;
  /// Why this line by hand, or a job, would be refused right now; nothing: it would be obeyed.
  [[nodiscard]] std::optional<Refused> why_no_line(Instant now, std::string_view text) const;
  [[nodiscard]] std::optional<Refused> why_no_job(Instant now) const;
  /// ResumeJob would be obeyed.
  [[nodiscard]] bool can_resume() const;
  /// The job under way, or the last one; empty before the first, and while the next one waits for its beginning.
  [[nodiscard]] const std::optional<job::JobState>& job() const { return job_state_; }
  /// What was not as at the last connection (RecallSettings), for the rest of this one.
  [[nodiscard]] const std::vector<machine::SettingDifference>& settings_drift() const { return settings_drift_; }
  /// Every line sent, answered and lost so far.
  [[nodiscard]] const streaming::Ledger& ledger() const { return streamer_.ledger(); }
  [[nodiscard]] std::size_t bytes_in_flight() const { return streamer_.ledger().bytes_in_flight(); }
  [[nodiscard]] std::size_t window_bytes() const { return streamer_.window(); }

 private:
  /// Answers whose room was used before they were worked out.
  struct Ahead {
    Instant at{};
    std::vector<protocol::ReceivedMessage> messages;
    /// One for each message.
    std::vector<streaming::OwedLine> answered{};
    std::vector<streaming::OwedLine> sent{};
  };

  [[nodiscard]] bool may_feed_ahead(Instant now, const std::vector<protocol::ReceivedMessage>& messages) const;
  void catch_up();
  void handle(Instant now, const protocol::ReceivedMessage& received);
  void take_in(Instant now, const protocol::ReceivedMessage& received, std::optional<streaming::OwedLine> answers);
  void on_answer(Instant now, const std::optional<streaming::OwedLine>& line, int error_code);
  void on_report(Instant now, vocabulary::MachineState before);
  void on_welcome(Instant now);
  void drop_lines_of_fresh_controller(Instant now);
  void on_alarm(Instant now, int code, const machine::Snapshot& before);
  void on_alarm_state();
  void follow_pendant(Instant now);

  void obey(Instant now, const StartJob& command);
  void begin_job(Instant now, const StartJob& command);
  void begin_waiting_job(Instant now);
  void obey(Instant now, const HoldJob& command);
  void obey(Instant now, const ResumeJob& command);
  void obey(Instant now, const StopJob& command);
  void obey(Instant now, const AbortJob& command);
  void obey(Instant now, const SendLine& command);
  void obey(Instant now, const SendRealtime& command);
  void obey(Instant now, const Unlock& command);
  void obey(Instant now, const Home& command);
  void obey(Instant now, const Jog& command);
  void obey(Instant now, const CancelJog& command);
  void obey(Instant now, const SoftReset& command);
  void obey(Instant now, const ChangeSettings& command);
  void obey(Instant now, const RecallSettings& command);
  void obey(Instant now, const RecallWords& command);
  void obey(Instant now, const TakeControl& command);
  [[nodiscard]] std::optional<std::string> why_text_is_eaten(std::string_view text) const;
  [[nodiscard]] std::optional<Refused> why_nothing(Instant now) const;
  [[nodiscard]] std::size_t longest_line_taken() const;
  void refuse(Refused reason, std::string detail = {});

  void settle_everything(Instant now);
  /// What the parts want done, but for the lines that now have room.
  void follow_parts(Instant now);
  void follow_handshake(Instant now);
  void follow_job(Instant now);
  void follow_path(Instant now, std::optional<Instant> asked);
  void watch_stall(Instant now);
  void on_parser_state(Instant now);
  void note_silence();
  void on_line_end_lost(Instant now, streaming::OwedLine line);
  void hold_for_stall(Instant now, std::vector<streaming::OwedLine> lines, job::StallProof proof);
  [[nodiscard]] job::StallFacts stall_facts() const;
  void obey_handshake(Instant now, const machine::HandshakeOrder& order);
  void obey_job(Instant now);
  void obey_job(Instant now, job::JobOrder order);
  void follow_stop(Instant now);
  void cancel_jog();
  [[nodiscard]] bool is_at_tool_change() const;
  [[nodiscard]] std::optional<Refused> why_no_tool_work(Instant now) const;
  void send_by_hand(Instant now, std::string text);
  void go_back_from_tool_work();
  void follow_tool_work(Instant now);
  void on_jog_answered(const streaming::OwedLine& line);
  void follow_settings(Instant now);
  void on_operator_line_accepted(Instant now, std::string_view text);
  void tell_drift();
  void tell_program_messages(std::uint32_t acknowledged_line);
  [[nodiscard]] std::vector<std::string> settings_queries() const;
  void pump(Instant now);
  void on_sent(Instant now, const std::vector<streaming::OwedLine>& lines);
  void poll(Instant now);
  void ask_for_reports(Instant now);
  void refresh(Instant now);
  void obey_refresh(RefreshOrder order);
  [[nodiscard]] bool may_be_silent() const;
  [[nodiscard]] bool is_for_kerf(const protocol::Message& message);
  [[nodiscard]] bool text_under_way() const;
  [[nodiscard]] machine::MachineKnowledge knowledge() const;
  [[nodiscard]] machine::Explanation explain(const machine::Incident& incident) const;
  void reset_controller(Instant now);
  void strike_out();
  void tell(Event event) { outbox_.events.push_back(std::move(event)); }
  void send_byte(vocabulary::Realtime byte);
  [[nodiscard]] const vocabulary::Dialect& dialect() const { return handshake_.collector().dialect(); }
  /// A jog is under way, or may be: the next report will tell.
  [[nodiscard]] bool may_be_jogging() const;
  [[nodiscard]] bool is_ready() const { return phase() == SessionPhase::Ready; }
  [[nodiscard]] bool changes_settings() const { return settings_change_ && !settings_change_->is_over(); }
  [[nodiscard]] bool has_job() const { return job_ && !job::is_final(job_->state().phase); }

  SessionOptions options_;
  Outbox outbox_;
  std::optional<Ahead> ahead_;
  bool open_ = false;
  protocol::MessageReader reader_;
  machine::MachineModel model_;
  machine::Handshake handshake_;
  streaming::Streamer streamer_;
  StatusPoller poller_;
  StateRefresh refresh_;
  PendantWatch pendant_;
  Incidents incidents_;
  /// 0x83 is out: the next `[GC:]` is for Kerf.
  bool parser_report_asked_ = false;
  /// 0x8C went out once; it toggles, so never twice.
  bool automatic_reports_asked_ = false;
  LineGate gate_;
  std::optional<job::Job> job_;
  std::optional<job::JobState> job_state_;
  /// Begins when the controller has told what stands before its first line, and is given up at `start_until_`.
  std::optional<StartJob> waiting_start_;
  Instant start_until_ = kNever;
  job::StallWatch stall_;
  job::LinkDoubt link_doubt_;
  /// What the job's lines come from.
  std::optional<JobFeed> feed_;
  /// Of motion that is no job's.
  job::StopSequence stop_;
  bool last_line_jogs_ = false;
  /// A jog was cancelled while others were owed.
  bool cancels_owed_jogs_ = false;
  job::PathWatch path_;
  ToolWork tool_work_;
  std::optional<SettingsChange> settings_change_;
  /// What the machine had at the last connection, until it was compared.
  std::optional<RecallSettings> recalled_;
  std::vector<machine::SettingDifference> settings_drift_;
  /// A soft reset is out and its welcome has not come; until then answers mean nothing (protocol.md 4.4).
  std::optional<Instant> reset_pending_until_;
};

}  // namespace kerf::session
