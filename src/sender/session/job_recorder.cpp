#include "sender/session/job_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <variant>

#include "common/base/text.hpp"
#include "sender/job/program_start.hpp"
#include "sender/session/record_text.hpp"

namespace kerf::session {
namespace {

using job::JobPhase;
using job::NoteKind;
using streaming::Purpose;

/// A write behind this and a commit at once stay below the 50 ms that a crash may cost.
constexpr Duration kBetweenAdvances = std::chrono::milliseconds{40};

job::MachineAtStart machine_at_start(const Session& session, const protocol::Secrets& secrets) {
  job::MachineAtStart machine = job::present_machine(session.snapshot(), session.capabilities());
  std::erase_if(machine.settings, [&secrets](const machine::SettingAssignment& setting) {
    return secrets.is_secret(setting.id, setting.value);
  });
  return machine;
}

/// What a controller reported and when, apart from what the job's lines tell.
void take_report(job::JobAdvanced& advanced, const machine::Snapshot& now) {
  advanced.reported_line = now.line_number;
  advanced.reported_at = now.reported_at;
  advanced.state = now.state;
  advanced.substate = now.substate;
  advanced.machine_position_mm = now.machine_position_mm;
  advanced.work_offset_mm = now.work_offset_mm;
  advanced.planner_blocks_free = now.planner_blocks_free;
  advanced.feed_mm_per_min = now.feed_mm_per_min;
  advanced.spindle_rpm = now.spindle_rpm;
  advanced.accessories = now.accessories;
  advanced.overrides = now.overrides;
  advanced.tool = now.tool;
}

/// Whether `now` tells more than that time has passed.
bool is_news(job::JobAdvanced now, const job::JobAdvanced& before) {
  now.reported_at = before.reported_at;
  now.elapsed_s = before.elapsed_s;
  now.held_s = before.held_s;
  return now != before;
}

std::string_view sentence_of(job::HoldCause cause) {
  switch (cause) {
    case job::HoldCause::Door: return "The safety door is open.";
    case job::HoldCause::ToolChange: return "The machine waits for a tool.";
    case job::HoldCause::ProgramPause: return "The program pauses.";
    case job::HoldCause::SingleBlock: return "Single block: the machine stops behind every line.";
    case job::HoldCause::Refusal: return "A line was refused; the operator is asked.";
    case job::HoldCause::Stall: return "Answers got lost; the operator is asked.";
    case job::HoldCause::OffPath: return "The machine does something else than the program says.";
    default: return "Held.";
  }
}

std::string_view sentence_of(LinkLoss loss) {
  switch (loss) {
    case LinkLoss::Closed: return "The other end closed the link.";
    case LinkLoss::Unplugged: return "The cable was unplugged or the device went away.";
    case LinkLoss::TimedOut: return "The link was given up: nothing came any more.";
    case LinkLoss::HungUp: return "Kerf itself closed the link.";
    case LinkLoss::Error: break;
  }
  return "The link failed.";
}

std::string text_of(const Command& command) {
  std::string text{name_of(command)};
  if (const auto* line = std::get_if<SendLine>(&command)) text += " " + line->text;
  if (const auto* byte = std::get_if<SendRealtime>(&command))
    text += " " + base::escape(std::string(1, static_cast<char>(byte->byte)));
  return text;
}

}  // namespace

/// Turns events into notes, and counts lines.
class JobRecorder::Listener {
 public:
  Listener(JobRecorder& recorder, Instant now, const Session& session)
      : recorder_(recorder), now_(now), session_(session) {}

  void operator()(const LineSent& sent) const {
    if (sent.purpose != Purpose::JobLine) return;
    recorder_.current_.line_sent = sent.file_line;
    recorder_.is_due_ = true;
  }
  void operator()(const LineReceived& received) const {
    if (const auto* said = std::get_if<protocol::Feedback>(&received.message)) note(NoteKind::Message, 0, said->text);
    const bool is_taken = std::holds_alternative<protocol::Ok>(received.message);
    if (!is_taken || !received.answers || received.answers->purpose != Purpose::JobLine) return;
    job::JobAdvanced& current = recorder_.current_;
    current.line_acknowledged = std::max(current.line_acknowledged, received.answers->file_line);
    current.bytes_acknowledged = std::max(current.bytes_acknowledged, received.answers->file_offset_after);
    recorder_.is_due_ = true;
  }
  void operator()(const StatusReported&) const {
    take_report(recorder_.current_, session_.snapshot());
    recorder_.follow_tool(now_, session_.snapshot());
    recorder_.is_due_ = recorder_.is_due_ || is_news(recorder_.current_, recorder_.written_);
  }
  void operator()(const JobProgressed& progressed) const { recorder_.follow_phase(now_, progressed.job); }
  void operator()(const JobEnded& ended) const { recorder_.close(now_, ended.job, session_); }
  void operator()(const LineRefused& refused) const {
    const job::Refusal& refusal = refused.refusal;
    note(NoteKind::LineRefused, refusal.file_line,
         "error:" + std::to_string(refusal.code) + " to '" + refusal.text + "': " + refusal.meaning);
  }
  void operator()(const LinesLost& lost) const {
    note(NoteKind::LinesLost, lost.lines.front().file_line,
         std::to_string(lost.lines.size()) + " lines were lost unread.");
  }
  void operator()(const AlarmRaised& alarm) const {
    note(NoteKind::AlarmRaised, 0, "ALARM:" + std::to_string(alarm.code) + " " + alarm.title + ". " + alarm.text);
  }
  void operator()(const ControllerReset& reset) const { note(NoteKind::ControllerReset, 0, reset.reason); }
  void operator()(const ControllerRestarted& restarted) const {
    note(NoteKind::ControllerStarted, 0,
         restarted.asked ? "The controller restarted, as asked." : "The controller restarted by itself.");
  }
  void operator()(const JobStalled& stalled) const {
    note(NoteKind::Stalled, stalled.stall.file_line, stalled.stall.headline);
  }
  void operator()(const ProgramSpoke& spoke) const { note(NoteKind::Message, spoke.file_line, spoke.text); }
  void operator()(const LinkSilent& silent) const {
    note(NoteKind::LinkSilent, 0, "No answer for " + base::to_fixed(silent.silent_for_s, 1) + " s.");
  }
  void operator()(const LinkAnswering&) const { note(NoteKind::LinkAnswering, 0, "The controller answers again."); }
  void operator()(const PendantTookOver& taken) const { note(NoteKind::PendantTookOver, 0, taken.sentence); }
  /// The others are not about the job.
  template <typename Other>
  void operator()(const Other&) const {}

 private:
  void note(NoteKind kind, std::uint32_t line, std::string text) const {
    recorder_.note(now_, kind, line, std::move(text));
  }

  JobRecorder& recorder_;
  const Instant now_;
  const Session& session_;
};

void JobRecorder::write_down(Instant now, job::JournalRecord::What what) {
  records_.push_back({.at = now, .job = job_, .what = std::move(what)});
}

void JobRecorder::note(Instant now, NoteKind kind, std::uint32_t line, std::string text) {
  if (is_open_) write_down(now, job::JobNoted{.kind = kind, .line = line, .text = std::move(text)});
}

void JobRecorder::on_command(Instant now, const Command& command) {
  if (const auto* start = std::get_if<StartJob>(&command)) {
    // Refused while another job runs: then that one's program stays what it was.
    if (!is_open_) start_ = *start;
    return;
  }
  note(now, NoteKind::Commanded, 0, text_of(command));
}

void JobRecorder::on_link_closed(Instant now, LinkLoss loss) {
  note(now, NoteKind::LinkLost, 0, std::string{sentence_of(loss)});
}

void JobRecorder::on_events(Instant now, std::span<const Event> events, const Session& session,
                            const protocol::Secrets& secrets) {
  for (const Event& event : events) {
    if (std::holds_alternative<JobStarted>(event)) begin(now, session, secrets);
    if (is_open_) std::visit(Listener(*this, now, session), event);
  }
  if (is_open_ && is_due_) advance(now, session, false);
}

void JobRecorder::begin(Instant now, const Session& session, const protocol::Secrets& secrets) {
  if (!start_.program) return;
  const job::Program& program = *start_.program;
  ++job_;
  is_open_ = true;
  is_due_ = false;
  written_ = current_ = {};
  // How far the job is, does not wait for its second report.
  written_at_ = now - kBetweenAdvances;
  take_report(current_, session.snapshot());
  write_down(now, job::JobBegun{.program = program.name(),
                                .hash = program.hash(),
                                .size_bytes = program.size_bytes(),
                                .lines = program.line_count(),
                                .origin = start_.origin,
                                .machine = machine_at_start(session, secrets)});
  start_ = {};
}

void JobRecorder::follow_phase(Instant now, const job::JobState& state) {
  const bool is_off = state.departure.has_value();
  if (!std::exchange(is_off_path_, is_off) && is_off)
    note(now, NoteKind::OffThePath, state.departure->file_line, job::describe(*state.departure));
  if (state.phase == current_.phase) return;
  const bool was_still = current_.phase == JobPhase::Held;
  current_.phase = state.phase;
  is_due_ = true;
  if (state.phase == JobPhase::Held)
    note(now, NoteKind::Held, state.progress.shown_line(), std::string{sentence_of(state.hold_cause)});
  if (was_still && state.phase == JobPhase::Running)
    note(now, NoteKind::WentOn, state.progress.shown_line(), "The job goes on.");
}

void JobRecorder::follow_tool(Instant now, const machine::Snapshot& snapshot) {
  if (!snapshot.tool || snapshot.tool == written_.tool) return;
  if (written_.tool) note(now, NoteKind::ToolChanged, 0, "Tool " + std::to_string(*snapshot.tool) + " is in.");
  written_.tool = snapshot.tool;
  is_due_ = true;
}

void JobRecorder::advance(Instant now, const Session& session, bool at_once) {
  if (!at_once && now < written_at_ + kBetweenAdvances) return;
  if (session.job()) {
    current_.elapsed_s = session.job()->progress.elapsed_s;
    current_.held_s = session.job()->progress.held_s;
    current_.executing = session.job()->progress.executing;
  }
  write_down(now, current_);
  written_ = current_;
  written_at_ = now;
  is_due_ = false;
}

void JobRecorder::close(Instant now, const job::JobState& state, const Session& session) {
  current_.phase = state.phase;
  advance(now, session, true);
  write_down(now, job::JobClosed{state});
  is_open_ = false;
  is_due_ = false;
}

Instant JobRecorder::next_deadline() const {
  return is_open_ && is_due_ ? written_at_ + kBetweenAdvances : kNever;
}

}  // namespace kerf::session
