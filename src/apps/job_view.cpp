#include "apps/job_view.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "apps/progress_text.hpp"
#include "apps/terminal.hpp"
#include "io/json.hpp"

namespace kerf::apps {
namespace {

using SteadyClock = std::chrono::steady_clock;
using namespace std::chrono_literals;

/// True at most once in `period`.
class Pace {
 public:
  explicit Pace(SteadyClock::duration period) : period_(period) {}
  bool is_due() {
    const auto now = SteadyClock::now();
    if (now < next_) return false;
    next_ = now + period_;
    return true;
  }

 private:
  SteadyClock::duration period_;
  SteadyClock::time_point next_{};
};

/// The headline, then what shows it and what to do, indented.
std::vector<std::string> alarm_lines(const session::AlarmRaised& alarm) {
  std::vector<std::string> lines{alarm.explanation.headline};
  for (const std::string& detail : machine::details_of(alarm.explanation)) lines.push_back("  " + detail);
  return lines;
}

std::vector<std::string> stall_lines(const job::Stall& stall) {
  std::vector<std::string> lines{stall.headline};
  for (const std::string& fact : stall.evidence) lines.push_back("  " + fact);
  for (const std::string& step : stall.steps) lines.push_back("  -> " + step);
  return lines;
}

std::string started_sentence(const job::JobState& job) {
  return fmt::format("Cutting {}, {} lines.", job.program, job.progress.lines_total);
}

class TerminalView final : public JobView {
 public:
  ~TerminalView() override { erase(); }

  void told(const Told& told) override {
    for (const std::string& text : told.lines) line(text);
  }
  void found(std::string_view sentence, const machine::Capabilities&) override { line(sentence); }
  void noted(std::string_view sentence) override { line(sentence); }
  void machine_said(std::string_view text) override { line(fmt::format("The machine says: {}", text)); }
  void started(const job::JobState& job) override {
    line(started_sentence(job) + " Ctrl-C or Space holds the machine.");
  }

  void progressed(const job::JobState& job, const machine::Snapshot& snapshot) override {
    if (job.phase != job::JobPhase::Held) question_.clear();
    if (!pace_.is_due()) return;
    compose(job, snapshot);
    draw();
  }

  void alarm_raised(const session::AlarmRaised& alarm) override {
    for (const std::string& text : alarm_lines(alarm)) line(text);
  }
  void stalled(const job::Stall& stall) override {
    for (const std::string& text : stall_lines(stall)) line(text);
  }
  void line_refused(const session::LineRefused& refused) override { line(refused.explanation.headline); }
  void asked(const job::JobState&, std::string_view question) override {
    erase();
    if (rows_.empty()) {
      // Before there is a job: nothing is drawn above it.
      put("{}", question);
      std::fflush(stdout);
      is_open_question_ = true;
      return;
    }
    question_ = question;
    draw();
  }

  void ended(const job::JobState& job, const machine::Snapshot& snapshot, ExitStatus status) override {
    question_.clear();
    compose(job, snapshot);
    draw();
    is_drawn_ = false;  // the last state stays to be seen
    finish(summary_of(job, snapshot), status);
  }

  void failed(std::string_view sentence, ExitStatus status) override { finish(std::string(sentence), status); }

 private:
  void finish(const std::string& text, ExitStatus status) {
    erase();
    if (status == ExitStatus::Done) {
      put("{}\n", text);
    } else {
      complain(text);
    }
  }

  void line(std::string_view text) {
    erase();
    put("{}\n", text);
    draw();
  }

  void compose(const job::JobState& job, const machine::Snapshot& snapshot) {
    const int columns = terminal_columns();
    rows_ = progress_bar(job, columns, utf8_) + "\x1b[K\n" + machine_line(snapshot, columns) + "\x1b[K\n";
  }

  /// Two rows, and a third with the question if there is one; the cursor rests at its end.
  void draw() {
    if (rows_.empty()) return;
    put("{}{}{}\x1b[J", is_drawn_ ? kTwoRowsUp : "", rows_, question_);
    is_drawn_ = true;
    std::fflush(stdout);
  }

  void erase() {
    if (std::exchange(is_open_question_, false)) put("\n");
    if (is_drawn_) put("{}\x1b[J", kTwoRowsUp);
    is_drawn_ = false;
    std::fflush(stdout);
  }

  static constexpr std::string_view kTwoRowsUp = "\r\x1b[2A";

  Pace pace_{100ms};
  const bool utf8_ = shows_utf8();
  std::string rows_;
  std::string question_;
  bool is_drawn_ = false;
  bool is_open_question_ = false;
};

class LineView final : public JobView {
 public:
  void told(const Told& told) override {
    for (const std::string& text : told.lines) line(text);
  }
  void found(std::string_view sentence, const machine::Capabilities&) override { line(sentence); }
  void noted(std::string_view sentence) override { line(sentence); }
  void machine_said(std::string_view text) override { line(fmt::format("The machine says: {}", text)); }
  void started(const job::JobState& job) override { line(started_sentence(job)); }

  void progressed(const job::JobState& job, const machine::Snapshot& snapshot) override {
    const int tenth = static_cast<int>(job.progress.percent / 10);
    if (tenth == shown_tenth_ && !pace_.is_due()) return;
    if (tenth != shown_tenth_) (void)pace_.is_due();
    shown_tenth_ = tenth;
    line(progress_line(job, snapshot));
  }

  void alarm_raised(const session::AlarmRaised& alarm) override {
    for (const std::string& text : alarm_lines(alarm)) line(text);
  }
  void stalled(const job::Stall& stall) override {
    for (const std::string& text : stall_lines(stall)) line(text);
  }
  void line_refused(const session::LineRefused& refused) override { line(refused.explanation.headline); }
  void asked(const job::JobState&, std::string_view question) override { line(question); }

  void ended(const job::JobState& job, const machine::Snapshot& snapshot, ExitStatus status) override {
    if (status == ExitStatus::Done) line(progress_line(job, snapshot));
    failed(summary_of(job, snapshot), status);
  }

  void failed(std::string_view sentence, ExitStatus status) override {
    if (status == ExitStatus::Done) {
      line(sentence);
    } else {
      complain(std::string(sentence));
    }
  }

 private:
  static void line(std::string_view text) {
    put("{}\n", text);
    std::fflush(stdout);
  }

  Pace pace_{2s};
  int shown_tenth_ = -1;
};

class JsonView final : public JobView {
 public:
  void told(const Told& told) override {
    if (!told.event.is_null()) emit(told.event);
  }
  void found(std::string_view sentence, const machine::Capabilities& capabilities) override {
    emit({{"event", "found"},
          {"sentence", sentence},
          {"firmware", capabilities.firmware},
          {"version", capabilities.version}});
  }
  void noted(std::string_view sentence) override { emit({{"event", "note"}, {"sentence", sentence}}); }
  void machine_said(std::string_view text) override { emit({{"event", "message"}, {"text", text}}); }
  void started(const job::JobState& job) override {
    emit({{"event", "started"}, {"program", job.program}, {"lines", job.progress.lines_total}});
  }

  void progressed(const job::JobState& job, const machine::Snapshot& snapshot) override {
    if (job.phase == phase_ && !pace_.is_due()) return;
    phase_ = job.phase;
    emit(progress_of(job, snapshot));
  }

  void alarm_raised(const session::AlarmRaised& alarm) override {
    emit({{"event", "alarm"},
          {"code", alarm.code},
          {"title", alarm.title},
          {"text", alarm.text},
          {"explanation", io::to_json(alarm.explanation)}});
  }
  void stalled(const job::Stall& stall) override { emit({{"event", "stalled"}, {"stall", io::to_json(stall)}}); }
  void line_refused(const session::LineRefused& refused) override {
    emit({{"event", "line_refused"},
          {"refusal", io::to_json(refused.refusal)},
          {"explanation", io::to_json(refused.explanation)}});
  }
  void asked(const job::JobState& job, std::string_view question) override {
    io::Json json{{"event", "held"}, {"cause", io::to_json(job.hold_cause)}, {"sentence", question}};
    if (job.tool_change) json["tool_change"] = io::to_json(*job.tool_change);
    emit(json);
  }

  void ended(const job::JobState& job, const machine::Snapshot& snapshot, ExitStatus status) override {
    emit(progress_of(job, snapshot));
    io::Json json{{"event", "ended"},
                  {"outcome", io::to_json(job.phase)},
                  {"exit_status", static_cast<int>(status)},
                  {"sentence", summary_of(job, snapshot)}};
    if (job.refusal) json["refusal"] = io::to_json(*job.refusal);
    if (job.alarm_code) json["alarm_code"] = *job.alarm_code;
    json["lines_refused"] = job.lines_refused;
    if (job.end_line > 0) json["end_line"] = job.end_line;
    json["aftermath"] = io::to_json(job.aftermath);
    json["position_suspect"] = job.position_suspect;
    emit(json);
  }

  void failed(std::string_view sentence, ExitStatus status) override {
    emit({{"event", "failed"}, {"exit_status", static_cast<int>(status)}, {"sentence", sentence}});
    if (status != ExitStatus::Done) complain(std::string(sentence));
  }

 private:
  static io::Json progress_of(const job::JobState& job, const machine::Snapshot& snapshot) {
    io::Json json{{"event", "progress"}, {"phase", io::to_json(job.phase)}, {"state", io::to_json(snapshot.state)}};
    json.update(io::to_json(job.progress));
    if (job.stall) json["waits_for"] = io::to_json(job.stall->cause);
    if (snapshot.feed_mm_per_min) json["feed_mm_per_min"] = *snapshot.feed_mm_per_min;
    if (snapshot.machine_position_mm) json["machine_position_mm"] = *snapshot.machine_position_mm;
    if (snapshot.work_position_mm) json["work_position_mm"] = *snapshot.work_position_mm;
    return json;
  }

  static void emit(const io::Json& json) {
    put("{}\n", io::print(json));
    std::fflush(stdout);
  }

  Pace pace_{500ms};
  job::JobPhase phase_ = job::JobPhase::Running;
};

/// What of the file was taken although a line before it was refused.
std::string aftermath_text(const job::JobState& job) {
  const std::uint32_t taken = job.aftermath.lines_executed_after_refusal;
  if (taken == 0) return " No line behind it was executed.";
  const bool one = taken == 1;
  return fmt::format(
      " {} line{} behind it had already been taken by the controller; what of {} was not cut when it stopped is "
      "dropped.",
      taken, one ? "" : "s", one ? "it" : "them");
}

std::string finished_text(const job::JobState& job) {
  const job::Progress& progress = job.progress;
  std::string text =
      fmt::format("Done: {} lines of {} in {}{}.", progress.lines_total, job.program, clock_text(progress.elapsed_s),
                  progress.held_s >= 1 ? fmt::format(" ({} of it held)", clock_text(progress.held_s)) : "");
  if (job.lines_refused > 0) text += " " + job.reason;
  return text;
}

}  // namespace

std::string summary_of(const job::JobState& job, const machine::Snapshot& snapshot) {
  const job::Progress& progress = job.progress;
  const std::string where = position_text(snapshot);
  switch (job.phase) {
    case job::JobPhase::Finished: return finished_text(job);
    case job::JobPhase::Refused:
      if (job.refusal) {
        return fmt::format("{}, line {}: the controller refused '{}' with error {}: {}{}", job.program,
                           job.refusal->file_line, job.refusal->text, job.refusal->code, job.refusal->meaning,
                           aftermath_text(job));
      }
      break;
    default: break;
  }
  std::string text = job.reason;
  if (progress.file_line > 0) {
    text += fmt::format(" The last line that was taken is {} of {}", progress.file_line, progress.lines_total);
    text += where.empty() ? "." : fmt::format(", the machine stands at {}.", where);
  }
  if (job.position_suspect) text += " The position may be wrong: home the machine before you go on.";
  return text;
}

std::unique_ptr<JobView> make_terminal_view() {
  return std::make_unique<TerminalView>();
}
std::unique_ptr<JobView> make_line_view() {
  return std::make_unique<LineView>();
}
std::unique_ptr<JobView> make_json_view() {
  return std::make_unique<JsonView>();
}

std::unique_ptr<JobView> make_view(bool json) {
  if (json) return make_json_view();
  return is_terminal(STDOUT_FILENO) ? make_terminal_view() : make_line_view();
}

}  // namespace kerf::apps
