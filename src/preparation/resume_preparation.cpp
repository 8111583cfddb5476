#include "preparation/resume_preparation.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "io/json.hpp"
#include "preparation/homing_wait.hpp"
#include "sender/job/resume_facts.hpp"
#include "sender/machine/explanation_evidence.hpp"
#include "simulation/resume_rehearsal.hpp"

namespace kerf::preparation {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

constexpr int kHoming = 22;
/// Modes and offsets are told at once, or never.
constexpr Duration kLongestAnswer = 10s;

bool can_be_homed(const session::Session& session) {
  return (static_cast<int>(machine::setting_number(session.capabilities(), kHoming).value_or(0)) & 1) != 0;
}

/// Why it will not come to rest by itself, and what to do about it; null where it will.
const char* why_never_at_rest(MachineState state) {
  switch (state) {
    case MachineState::Alarm:
      return "The machine is in alarm: kerf status says why. Clear it in kerf console ($X), see that the tool is where "
             "the machine says, then resume again.";
    case MachineState::Hold:
      return "The machine is held, with lines of before still in it. Reset it while it stands (Ctrl-X in kerf "
             "console): it keeps its position. Then resume again.";
    case MachineState::Door:
      return "The safety door is open, or the machine waits behind it. Close it and reset the machine (Ctrl-X in kerf "
             "console), then resume again.";
    case MachineState::Tool:
      return "The machine waits for a tool change of before. Reset it (Ctrl-X in kerf console), put in the tool that "
             "the plan names, then resume again.";
    case MachineState::Check:
      return "The machine is in check mode, where nothing moves. Leave it ($C in kerf console), then resume again.";
    case MachineState::Sleep: return "The machine sleeps. Reset it (Ctrl-X in kerf console), then resume again.";
    default: return nullptr;
  }
}

class ResumePreparation final : public JobPreparation {
 public:
  explicit ResumePreparation(ResumeWish wish) : wish_(std::move(wish)) {}

  void on_event(const session::Event& event) override { homing_.on_event(event); }

  NextInPreparation next(Instant at, const session::Session& session) override {
    if (asked_ != Question::None) return KeepWaiting{};
    if (ready_) return when_heard(at, session.snapshot());
    if (homing_.has_begun() && !is_homed_) return follow_homing(at, session);
    const machine::Snapshot& now = session.snapshot();
    const bool needs_home = can_be_homed(session) && !wish_.choice.position_is_confirmed && !is_homed_ &&
                            (wish_.work || !now.homing.all.value_or(false));
    const bool may_be_in_alarm = now.state == MachineState::Alarm && needs_home;
    if (now.state != MachineState::Idle && !may_be_in_alarm) {
      if (const char* why = why_never_at_rest(now.state); why != nullptr) return give_up({}, why);
      return KeepWaiting{};
    }
    if (const char* question = what_to_ask(now); question != nullptr) return ask_machine(at, question);
    last_asked_.clear();
    return plan(at, session, needs_home);
  }

  void agree() override {
    if (asked_ == Question::Home) may_home_ = true;
    if (asked_ == Question::Run) may_run_ = true;
    asked_ = Question::None;
  }

 private:
  enum class Question { None, Home, Run };

  NextInPreparation home(Instant at, const machine::Snapshot& now, const job::ResumePlan& made) {
    if (!may_home_ && !wish_.says_yes) {
      asked_ = Question::Home;
      return AskOperator{
          .told = {.lines = {"Job and machine fit; it can go on from line " + std::to_string(made.from_line) + ".",
                             "First the machine is homed, so that its position is certain. It moves now: Z goes up "
                             "before all else. Is the way to the switches free?"}},
          .question = "Home now?"};
    }
    homing_.begin(at, now);
    return get_ready(at, now, session::Command{session::Home{}});
  }

  /// The plan of a long program takes seconds, in which nobody listened to the machine: it is heard first.
  NextInPreparation get_ready(Instant at, const machine::Snapshot& now, NextInPreparation what) {
    ready_ = std::move(what);
    ready_at_ = at;
    reports_when_ready_ = now.reports;
    return KeepWaiting{};
  }

  NextInPreparation when_heard(Instant at, const machine::Snapshot& now) {
    const bool is_heard = now.reports != reports_when_ready_;
    if (!is_heard && at - ready_at_ < kLongestAnswer) return KeepWaiting{};
    return *std::exchange(ready_, std::nullopt);
  }

  NextInPreparation follow_homing(Instant at, const session::Session& session) {
    switch (homing_.look(at, session.snapshot())) {
      case HomingWait::Verdict::Waiting: return KeepWaiting{};
      case HomingWait::Verdict::Homed: break;
      case HomingWait::Verdict::Failed:
        return give_up({}, homing_.sentence() +
                               " No line of the job was sent. Home the machine (kerf console, $H), then resume again; "
                               "or, if its position is right all the same, say --position-is-right.");
    }
    is_homed_ = true;
    return session::Command{session::SendLine{"$#"}};
  }

  /// What is missing for a plan; each is asked once, and then waited for.
  const char* what_to_ask(const machine::Snapshot& now) const {
    if (now.parser_words.empty() || now.parser_state_is_old) return "$G";
    if (now.offsets_mm.empty() || now.offsets_are_old) return "$#";
    return nullptr;
  }

  NextInPreparation ask_machine(Instant at, std::string_view line) {
    if (last_asked_ != line) {
      last_asked_ = line;
      asked_at_ = at;
      return session::Command{session::SendLine{std::string{line}}};
    }
    if (at - asked_at_ < kLongestAnswer) return KeepWaiting{};
    return give_up({}, "The machine did not answer " + last_asked_ +
                           " within 10 s, so its modes and offsets are not known. Look at it with kerf status, then "
                           "resume again.");
  }

  NextInPreparation give_up(Told told, std::string sentence) const {
    return NoJob{.told = std::move(told), .sentence = std::move(sentence)};
  }

  [[nodiscard]] job::ResumeFacts facts(Instant at, const session::Session& session, bool will_be_homed) const {
    const machine::Snapshot& now = session.snapshot();
    const job::Program& file = *wish_.file.program();
    job::ResumeFacts facts =
        wish_.work ? job::facts_of_job(wish_.work->history, wish_.work->file_start, file, now, session.capabilities())
                   : job::facts_of_present(now, session.capabilities());
    facts.will_be_homed = will_be_homed;
    facts.silent_for_s = session.link_health(at).silent_for_s;
    return facts;
  }

  NextInPreparation plan(Instant at, const session::Session& session, bool needs_home) {
    const job::Program& file = *wish_.file.program();
    const auto made = job::plan_resume(file, facts(at, session, needs_home), wish_.choice);
    if (!made) return refused(made.error());
    // Nothing moves before it is clear that there is a plan.
    if (needs_home && !wish_.dry_run) return home(at, session.snapshot(), *made);
    const auto rehearsal = simulation::rehearse_resume(file, *made, session.snapshot(), session.capabilities());
    if (!rehearsal) return refused(rehearsal.error());
    Told told{.lines = job::text_of(*made),
              .event = {{"event", "plan"}, {"plan", io::to_json(*made)}, {"rehearsal", io::to_json(*rehearsal)}}};
    told.lines.push_back(rehearsal->sentence);
    if (wish_.dry_run) {
      told.lines.emplace_back("A dry run: nothing was sent.");
      return NoJob{.told = std::move(told), .reason = NoJob::Reason::NotWished};
    }
    if (!may_run_ && !wish_.says_yes) {
      asked_ = Question::Run;
      return AskOperator{.told = std::move(told), .question = "Is everything as these steps say? Go on?"};
    }
    return get_ready(at, session.snapshot(), begin(may_run_ ? Told{} : std::move(told), *made));
  }

  NextInPreparation refused(const job::ResumeRefusal& refusal) const {
    return give_up({.lines = {}, .event = {{"event", "refused"}, {"refusal", io::to_json(refusal)}}},
                   refusal.sentence + (refusal.next.empty() ? "" : " " + refusal.next));
  }

  [[nodiscard]] NextInPreparation begin(Told told, const job::ResumePlan& made) const {
    const auto& file = wish_.file.program();
    session::StartJob job{.program = file, .origin = {}};
    if (!made.steps.empty()) {
      auto rest = assemble(*file, made);
      if (!rest) return give_up({}, io::explain(rest.error(), file->name()));
      job.program = *std::move(rest);
      job.origin = job::origin_of(made);
      job.origin.file_hash = file->hash();
    }
    job.origin.path = wish_.path;
    if (wish_.work) job.origin.continues = wish_.work->number;
    return BeginJob{.told = std::move(told), .job = std::move(job)};
  }

  [[nodiscard]] std::expected<std::shared_ptr<const job::Program>, io::ProgramFileError> assemble(
      const job::Program& file, const job::ResumePlan& made) const {
    const job::ResumedText text = job::resumed_text(file, made);
    auto rest = io::ProgramFile::assemble(file.name(), [this, &text](const io::ProgramFile::Put& put) {
      const std::string blank_lines(std::min<std::size_t>(text.blank_lines, 4096), '\n');
      for (std::size_t left = text.blank_lines; left > 0; left -= std::min(left, blank_lines.size())) {
        put(std::string_view{blank_lines}.substr(0, left));
      }
      put(text.head);
      constexpr std::size_t kPieceBytes = std::size_t{1} << 20U;
      for (std::size_t at = 0; at < text.rest.size(); at += kPieceBytes) {
        put(text.rest.substr(at, kPieceBytes));
        wish_.file.give_back();
      }
    });
    if (!rest) return std::unexpected{std::move(rest.error())};
    return rest->program();
  }

  ResumeWish wish_;
  Question asked_ = Question::None;
  bool may_home_ = false;
  bool may_run_ = false;
  HomingWait homing_;
  bool is_homed_ = false;
  std::string last_asked_;
  Instant asked_at_{};
  /// What is decided, and waits for the next report.
  std::optional<NextInPreparation> ready_;
  Instant ready_at_{};
  std::uint64_t reports_when_ready_ = 0;
};

}  // namespace

std::unique_ptr<JobPreparation> prepare_resume(ResumeWish wish) {
  return std::make_unique<ResumePreparation>(std::move(wish));
}

}  // namespace kerf::preparation
