#include "apps/resume_preparation.hpp"

#include <utility>

#include "io/json.hpp"
#include "sender/job/resume_facts.hpp"
#include "sender/machine/explanation_evidence.hpp"
#include "simulation/resume_rehearsal.hpp"

namespace kerf::apps {
namespace {

using vocabulary::MachineState;

constexpr int kHoming = 22;

bool can_be_homed(const session::Session& session) {
  return (static_cast<int>(machine::setting_number(session.capabilities(), kHoming).value_or(0)) & 1) != 0;
}

class ResumePreparation final : public JobPreparation {
 public:
  explicit ResumePreparation(ResumeWish wish) : wish_(std::move(wish)) {}

  NextInPreparation next(const session::Session& session) override {
    const machine::Snapshot& now = session.snapshot();
    if (asked_ != Question::None) return KeepWaiting{};
    const bool needs_home = can_be_homed(session) && !wish_.choice.position_is_confirmed && !is_homed_ &&
                            (wish_.work || !now.homing.all.value_or(false));
    if (needs_home && !wish_.dry_run) return home(now);
    const bool is_at_rest = now.state == MachineState::Idle || (wish_.dry_run && now.state == MachineState::Alarm);
    if (!is_at_rest) {
      if (now.state == MachineState::Alarm) return give_up({}, "The machine is in alarm: clear it first.");
      return KeepWaiting{};
    }
    if (const char* question = what_to_ask(now); question != nullptr) return ask_machine(question);
    return plan(session, needs_home);
  }

  void agree() override {
    if (asked_ == Question::Home) may_home_ = true;
    if (asked_ == Question::Run) may_run_ = true;
    asked_ = Question::None;
  }

 private:
  enum class Question { None, Home, Run };

  NextInPreparation home(const machine::Snapshot& now) {
    if (is_homing_) {
      if (now.state == MachineState::Home || now.reports == reports_at_home_) return KeepWaiting{};
      if (now.state != MachineState::Idle || !now.homing.all.value_or(false)) return KeepWaiting{};
      is_homed_ = true;
      return session::Command{session::SendLine{"$#"}};
    }
    if (!may_home_ && !wish_.says_yes) {
      asked_ = Question::Home;
      return AskOperator{
          .told = {"The machine is homed first, so that its position is known: Z goes up before all else."},
          .question = "Home now? [y/N] "};
    }
    is_homing_ = true;
    reports_at_home_ = now.reports;
    return session::Command{session::Home{}};
  }

  /// What is missing for a plan; each is asked once, and then waited for.
  const char* what_to_ask(const machine::Snapshot& now) const {
    if (now.parser_words.empty() || now.parser_state_is_old) return "$G";
    if (now.offsets_mm.empty() || now.offsets_are_old) return "$#";
    return nullptr;
  }

  NextInPreparation ask_machine(std::string_view line) {
    if (last_asked_ == line) return KeepWaiting{};
    last_asked_ = line;
    return session::Command{session::SendLine{std::string{line}}};
  }

  NextInPreparation give_up(std::vector<std::string> told, std::string sentence) const {
    return NoJob{.told = std::move(told), .sentence = std::move(sentence), .status = ExitStatus::Usage};
  }

  NextInPreparation plan(const session::Session& session, bool will_be_homed) {
    const machine::Snapshot& now = session.snapshot();
    job::ResumeFacts facts = wish_.work ? job::facts_of_job(wish_.work->history, wish_.work->file_start, *wish_.file,
                                                            now, session.capabilities())
                                        : job::facts_of_present(now, session.capabilities());
    facts.will_be_homed = will_be_homed;
    const auto made = job::plan_resume(*wish_.file, facts, wish_.choice);
    if (!made) return refused(made.error());
    const auto rehearsal = simulation::rehearse_resume(*wish_.file, *made, now, session.capabilities());
    if (!rehearsal) return refused(rehearsal.error());
    std::vector<std::string> told;
    if (wish_.json) {
      io::Json shown;
      shown["plan"] = io::to_json(*made);
      shown["rehearsal"] = io::to_json(*rehearsal);
      told.push_back(io::print(shown));
    } else {
      told = job::text_of(*made);
      told.push_back(rehearsal->sentence);
    }
    if (wish_.dry_run) return NoJob{.told = std::move(told), .status = ExitStatus::Done};
    if (!may_run_ && !wish_.says_yes) {
      asked_ = Question::Run;
      return AskOperator{.told = std::move(told), .question = "Is everything as these steps say? Go on? [y/N] "};
    }
    if (may_run_) told.clear();
    return begin(std::move(told), *made);
  }

  NextInPreparation refused(const job::ResumeRefusal& refusal) const {
    std::vector<std::string> told;
    if (wish_.json) {
      io::Json shown;
      shown["refusal"] = io::to_json(refusal);
      told.push_back(io::print(shown));
    }
    return give_up(std::move(told), refusal.sentence + (refusal.next.empty() ? "" : " " + refusal.next));
  }

  [[nodiscard]] BeginJob begin(std::vector<std::string> told, const job::ResumePlan& made) const {
    job::ResumedProgram resumed{.program = wish_.file, .origin = {}};
    if (!made.steps.empty()) {
      resumed = job::resumed_program(*wish_.file, made);
      resumed.origin.file_hash = wish_.file->hash();
    }
    resumed.origin.path = wish_.path;
    if (wish_.work) resumed.origin.continues = wish_.work->number;
    return {.told = std::move(told), .job = {.program = resumed.program, .origin = resumed.origin}};
  }

  ResumeWish wish_;
  Question asked_ = Question::None;
  bool may_home_ = false;
  bool may_run_ = false;
  bool is_homing_ = false;
  bool is_homed_ = false;
  std::uint64_t reports_at_home_ = 0;
  std::string last_asked_;
};

}  // namespace

std::unique_ptr<JobPreparation> prepare_resume(ResumeWish wish) {
  return std::make_unique<ResumePreparation>(std::move(wish));
}

}  // namespace kerf::apps
