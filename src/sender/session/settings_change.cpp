#include "sender/session/settings_change.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/vocabulary/machine_state.hpp"
#include "sender/machine/rest.hpp"
#include "sender/machine/setting_value.hpp"
#include "sender/machine/startup_line.hpp"

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using machine::SettingDifference;

/// A report comes within a poll period; Grbl may be storing.
constexpr Duration kReportPatience = 3s;
/// Storing takes milliseconds, waiting for the planner to empty may take longer.
constexpr Duration kWritePatience = 5s;
/// Counted from the last row.
constexpr Duration kListPatience = 5s;
constexpr std::size_t kNamedInSentence = 4;

std::string count_of(std::size_t count, std::string_view noun) {
  return std::to_string(count) + " " + std::string{noun} + (count == 1 ? "" : "s");
}

std::string list_of(const std::vector<SettingDifference>& differences) {
  std::string text;
  for (std::size_t index = 0; index < differences.size() && index < kNamedInSentence; ++index) {
    if (index > 0) text += "; ";
    text += machine::sentence_of(differences[index]);
  }
  if (differences.size() > kNamedInSentence) {
    text += "; and " + std::to_string(differences.size() - kNamedInSentence) + " more";
  }
  return text;
}

std::string ids_of(const std::vector<std::string>& ids) {
  std::string text;
  for (const std::string& id : ids) text += (text.empty() ? "$" : ", $") + id;
  return text;
}

}  // namespace

SettingsChange::SettingsChange(Instant now, machine::Capabilities machine, machine::SettingsPlan plan,
                               std::vector<std::string> queries, bool reads_single_settings, std::string reason)
    : machine_(std::move(machine)),
      initial_(machine::settings_of(machine_)),
      asked_(plan.steps),
      steps_(std::move(plan.steps)),
      queries_(std::move(queries)),
      reads_single_(reads_single_settings) {
  result_.reason = std::move(reason);
  ask_for_rest(now);
}

void SettingsChange::ask_for_rest(Instant now) {
  orders_.emplace_back(AskForReport{});
  phase_ = Phase::AwaitingRest;
  deadline_ = now + kReportPatience;
}

void SettingsChange::on_report(Instant now, const machine::Snapshot& snapshot) {
  if (asks_why_) return end_unanswered(snapshot);
  if (phase_ != Phase::AwaitingRest) return;
  if (may_move_ && snapshot.state == vocabulary::MachineState::Run) {
    deadline_ = now + kReportPatience;
    return;
  }
  if (!machine::may_store_settings(snapshot)) {
    interrupt("the machine is not at rest any more (" + std::string{vocabulary::name_of(snapshot.state)} + ")");
    return;
  }
  if (at_ < steps_.size())
    write(now);
  else
    read_all(now);
}

void SettingsChange::send(Instant now, Phase phase, std::string line) {
  orders_.emplace_back(SendSettingLine{std::move(line)});
  phase_ = phase;
  deadline_ = now + (phase == Phase::ReadingAll ? kListPatience : kWritePatience);
}

void SettingsChange::write(Instant now) {
  const SettingDifference& step = steps_[at_];
  send(now, Phase::Writing, "$" + step.id + "=" + step.after);
}

void SettingsChange::on_value(std::string_view id, std::string_view value) {
  for (machine::SettingFact& setting : machine_.settings) {
    if (setting.id == id) setting.value = std::string{value};
  }
}

std::string SettingsChange::value_of(std::string_view id) const {
  const machine::SettingFact* setting = machine_.find_setting(id);
  return setting == nullptr ? std::string{} : setting->value.value_or("");
}

bool SettingsChange::is_secret(std::string_view id) const {
  const machine::SettingFact* setting = machine_.find_setting(id);
  return setting != nullptr && machine::is_password(*setting);
}

SettingDifference SettingsChange::without_secret(SettingDifference step) const {
  if (is_secret(step.id)) step.before = step.after = std::string{machine::kStars};
  return step;
}

bool SettingsChange::is_set(const SettingDifference& step) const {
  const machine::SettingFact* setting = machine_.find_setting(step.id);
  if (setting == nullptr) return false;
  // Some controllers show stars (grblHAL settings.c): then its `ok` has to do.
  const std::string value = setting->value.value_or("");
  if (machine::is_password(*setting) && value == machine::kStars) return true;
  return machine::is_same_value(*setting, value, step.after);
}

std::string SettingsChange::what_it_has(const SettingDifference& step) const {
  if (is_secret(step.id)) return "the controller has another password than was sent.";
  return "the controller has " + value_of(step.id) + " instead of " + step.after + ".";
}

void SettingsChange::on_answer(Instant now, int error_code, std::string_view meaning) {
  if (phase_ == Phase::Over || phase_ == Phase::AwaitingRest) return;
  if (phase_ == Phase::ReadingAll) {
    if (error_code != 0) {
      interrupt("the controller does not list its settings now (" + std::string{meaning} + ")");
      return;
    }
    if (++query_ < queries_.size())
      send(now, Phase::ReadingAll, queries_[query_]);
    else
      judge(now);
    return;
  }
  const SettingDifference step = steps_[at_];
  if (error_code != 0) {
    fail(now, step, "the controller refused it: " + std::string{meaning});
  } else if (phase_ == Phase::Writing && reads_single_ && !machine::is_startup_line(step.id)) {
    send(now, Phase::ReadingOne, "$" + step.id);
  } else if (phase_ == Phase::ReadingOne && !is_set(step)) {
    fail(now, step, what_it_has(step));
  } else {
    go_on(now);
  }
}

void SettingsChange::go_on(Instant now) {
  if (!rolling_back_ && !second_pass_) {
    orders_.emplace_back(
        NoteSetting{.difference = without_secret(steps_[at_]), .step = at_ + 1, .steps = steps_.size()});
  }
  next_step(now);
}

void SettingsChange::next_step(Instant now) {
  may_move_ = machine::is_startup_line(steps_[at_].id);
  if (++at_ < steps_.size() || may_move_)
    ask_for_rest(now);
  else
    read_all(now);
}

void SettingsChange::read_all(Instant now) {
  query_ = 0;
  send(now, Phase::ReadingAll, queries_.front());
}

/// All values were read: is everything as it was asked for?
void SettingsChange::judge(Instant now) {
  if (rolling_back_)
    end_rollback(now);
  else
    end_forward(now);
}

void SettingsChange::fail(Instant now, const SettingDifference& step, std::string sentence) {
  const machine::SettingFact* setting = machine_.find_setting(step.id);
  const std::string label = setting == nullptr ? "$" + step.id : machine::label_of(*setting);
  result_.refused.push_back(
      {.id = step.id, .fault = machine::SettingFault::NotTaken, .sentence = label + ": " + std::move(sentence)});
  if (rolling_back_) return next_step(now);
  // Writing may have changed more than what was asked for: only the whole list shows what has to go back.
  rolling_back_ = true;
  steps_.clear();
  at_ = 0;
  second_pass_ = false;
  if (may_move_)
    ask_for_rest(now);
  else
    read_all(now);
}

void SettingsChange::end_forward(Instant now) {
  std::vector<SettingDifference> missing;
  for (const SettingDifference& step : asked_) {
    if (!is_set(step)) missing.push_back(step);
  }
  if (missing.empty()) {
    finish(SettingsOutcome::Done, {});
  } else if (second_pass_) {
    fail(now, missing.front(),
         "the controller has " + value_of(missing.front().id) + " instead of " + missing.front().after + ".");
  } else {
    // Another value pushed it aside, such as homing that was switched on afterwards.
    second_pass_ = true;
    steps_ = std::move(missing);
    at_ = 0;
    ask_for_rest(now);
  }
}

/// What differs from the values before, in the order in which it can be put back.
std::vector<SettingDifference> SettingsChange::left_to_undo() const {
  auto steps = machine::differences(machine_, machine::settings_of(machine_), initial_);
  std::erase_if(steps, [](const SettingDifference& step) { return !step.known_after; });
  for (const SettingDifference& step : asked_) {
    if (!is_secret(step.id) || step.before == machine::kStars || value_of(step.id) == step.before) continue;
    SettingDifference undo = step;
    std::swap(undo.before, undo.after);
    steps.push_back(std::move(undo));
  }
  return machine::in_writing_order(machine_.family, std::move(steps));
}

void SettingsChange::end_rollback(Instant now) {
  auto left = left_to_undo();
  if (left.empty()) {
    finish(SettingsOutcome::RolledBack, {});
  } else if (second_pass_) {
    finish(SettingsOutcome::RollbackFailed, {});
  } else {
    // The first time this is the rollback itself; after it, what still differs is tried once more.
    second_pass_ = !steps_.empty();
    steps_ = std::move(left);
    at_ = 0;
    ask_for_rest(now);
  }
}

void SettingsChange::interrupt(std::string why) {
  if (phase_ == Phase::Over) return;
  finish(SettingsOutcome::Interrupted, std::move(why));
}

void SettingsChange::advance_to(Instant now) {
  if (phase_ == Phase::Over || now < deadline_) return;
  if (asks_why_ || phase_ == Phase::AwaitingRest) return finish(SettingsOutcome::Unanswered, {});
  asks_why_ = true;
  orders_.emplace_back(AskForReport{});
  deadline_ = now + kReportPatience;
}

/// A controller that is held answers nothing until it goes on (protocol.md 9.1).
void SettingsChange::end_unanswered(const machine::Snapshot& snapshot) {
  using vocabulary::MachineState;
  const bool is_held = snapshot.state == MachineState::Hold || snapshot.state == MachineState::Door ||
                       snapshot.state == MachineState::Tool;
  finish(is_held ? SettingsOutcome::Held : SettingsOutcome::Unanswered,
         is_held ? std::string{vocabulary::name_of(snapshot.state)} : std::string{});
}

std::vector<SettingDifference> SettingsChange::changed_so_far() const {
  return machine::differences(machine_, initial_, machine::settings_of(machine_));
}

void SettingsChange::finish(SettingsOutcome outcome, std::string sentence) {
  phase_ = Phase::Over;
  deadline_ = kNever;
  result_.outcome = outcome;
  for (SettingDifference& difference : changed_so_far()) {
    const bool was_asked = std::ranges::find(asked_, difference.id, &SettingDifference::id) != asked_.end();
    if (was_asked && difference.reboot_required) result_.reboot_required.push_back(difference.id);
    (was_asked ? result_.changed : result_.also_changed).push_back(std::move(difference));
  }
  // Passwords are not compared, but they were written.
  for (const SettingDifference& step : asked_) {
    if (outcome == SettingsOutcome::Done && is_secret(step.id)) result_.changed.push_back(without_secret(step));
  }
  const std::string why = result_.refused.empty() ? "" : " " + result_.refused.front().sentence;
  switch (outcome) {
    case SettingsOutcome::Done:
      result_.sentence = "Changed " + count_of(asked_.size(), "setting") + ", read back and found set.";
      break;
    case SettingsOutcome::RolledBack:
      result_.sentence = "Nothing was changed: the values from before are back, because one was not taken." + why;
      break;
    case SettingsOutcome::RollbackFailed:
      result_.sentence = "One setting was not taken, and not all values from before could be put back." + why +
                         " Restore an earlier set.";
      break;
    case SettingsOutcome::Interrupted:
      result_.sentence = "The change was broken off because " + sentence + "; " +
                         count_of(result_.changed.size(), "setting") + " of " + std::to_string(asked_.size()) +
                         " may have been changed: compare before you go on.";
      break;
    case SettingsOutcome::Unanswered:
      result_.sentence = "The controller stopped answering while settings were written; compare before you go on.";
      break;
    case SettingsOutcome::Held:
      result_.sentence = "The machine was held (" + sentence +
                         ") while settings were written, and answers only when it goes on: resume or reset it, then "
                         "compare.";
      break;
    default: break;
  }
  if (!result_.also_changed.empty() && outcome == SettingsOutcome::Done) {
    result_.sentence += " The controller also changed " + list_of(result_.also_changed) + ".";
  }
  if (!result_.reboot_required.empty()) {
    result_.sentence += " Switch the controller off and on for " + ids_of(result_.reboot_required) + " to act.";
  }
}

std::vector<SettingsOrder> SettingsChange::take_orders() {
  return std::exchange(orders_, {});
}

SettingsResult invalid_settings(std::vector<machine::SettingRefusal> refusals, std::string reason) {
  std::string sentence = refusals.front().sentence;
  if (refusals.size() > 1) {
    sentence += " " + std::to_string(refusals.size() - 1) + " more cannot be set either; nothing was sent.";
  }
  return {.outcome = SettingsOutcome::Invalid,
          .reason = std::move(reason),
          .sentence = std::move(sentence),
          .changed = {},
          .also_changed = {},
          .refused = std::move(refusals),
          .reboot_required = {}};
}

SettingsResult unchanged_settings(std::string reason) {
  return {.outcome = SettingsOutcome::Unchanged,
          .reason = std::move(reason),
          .sentence = "Nothing to do: the machine has these values already.",
          .changed = {},
          .also_changed = {},
          .refused = {},
          .reboot_required = {}};
}

std::string drift_sentence(const std::vector<SettingDifference>& differences, std::string_view since) {
  return count_of(differences.size(), "setting") + (differences.size() == 1 ? " is" : " are") +
         " not as Kerf last saw " + (differences.size() == 1 ? "it" : "them") +
         (since.empty() ? std::string{} : " (" + std::string{since} + ")") + ": " + list_of(differences) + ".";
}

}  // namespace kerf::session
