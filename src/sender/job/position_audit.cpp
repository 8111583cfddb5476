#include "sender/job/position_audit.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/text.hpp"

namespace kerf::job {
namespace {

using namespace std::chrono_literals;
using machine::SettingAssignment;
using vocabulary::MachineState;

/// The first moves of a search; the last are single steps.
constexpr double kCoarseMm = 0.25;
constexpr double kMiddleMm = 0.02;
/// How fast a switch is met, in units of the rate at which homing meets it.
constexpr double kCoarseRate = 4;
/// Reports have three decimals.
constexpr double kReportGrainMm = 0.0006;
/// A large machine that seeks slowly takes minutes; a controller gives up by itself behind its travel.
constexpr Duration kLongestHoming = 15min;
constexpr Duration kLongestStop = 20s;
/// What a move takes beyond its length and rate: ramps, the wire, the next report.
constexpr Duration kAllowance = 20s;

Duration travel_time(double mm, double mm_per_min) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double, std::ratio<60>>(mm / mm_per_min));
}

std::string list_of(const std::vector<SettingAssignment>& settings) {
  std::string text;
  for (const SettingAssignment& setting : settings) {
    text += (text.empty() ? "" : " and ") + ("$" + setting.id) + "=" + setting.value;
  }
  return text;
}

}  // namespace

PositionAudit::PositionAudit(Instant now, AuditPlan plan, double tolerance_mm) : plan_(std::move(plan)) {
  result_.tolerance_mm = tolerance_mm;
  for (const AuditAxis& axis : plan_.axes) {
    result_.axes.push_back({.axis = std::string{axis.letter}, .step_mm = 1 / axis.steps_per_mm});
  }
  // What an earlier audit left off is put back in the end, too.
  are_off_ = !plan_.protections.empty();
  if (plan_.protections_off.empty()) {
    begin_round(now);
  } else {
    orders_.emplace_back(AuditChangeSettings{plan_.protections_off});
  }
}

std::vector<AuditOrder> PositionAudit::take_orders() {
  return std::exchange(orders_, {});
}

std::int64_t PositionAudit::steps_of(double mm) const {
  return std::llround(mm * axis().steps_per_mm);
}

void PositionAudit::begin_round(Instant now) {
  at_ = 0;
  begin_axis(now);
}

void PositionAudit::begin_axis(Instant now) {
  const double switch_mm = axis().home_mm + axis().direction * plan_.pull_off_mm;
  const double begin_mm = switch_mm - axis().direction * std::max(kAuditRangeMm, plan_.pull_off_mm);
  phase_ = Phase::Approaching;
  // Before the first report it is not known where the axis is.
  if (!last_) return;
  note(std::string{round_ == 0 ? "Measuring " : "Measuring again: "} + axis().letter + ".");
  const double at_mm = (*last_->machine_position_mm)[axis().index];
  if ((at_mm - begin_mm) * axis().direction < 0) {
    go(now, steps_of(begin_mm), plan_.seek_mm_per_min);
  } else {
    begin_search(now, steps_of(at_mm), last_->inputs->limits.contains(axis().letter));
  }
}

SwitchSearch PositionAudit::search() const {
  const double switch_mm = axis().home_mm + axis().direction * plan_.pull_off_mm;
  const auto move = [&](double mm) { return std::max<std::int64_t>(1, steps_of(mm)); };
  return {.direction = axis().direction,
          .moves = {move(kCoarseMm), move(kMiddleMm), 1},
          .back_off = move(plan_.pull_off_mm),
          .farthest = steps_of(switch_mm + axis().direction * kAuditRangeMm)};
}

void PositionAudit::begin_search(Instant now, std::int64_t at, bool is_closed) {
  finder_ = SwitchFinder(search(), at, is_closed);
  phase_ = Phase::Searching;
  follow_search(now);
}

void PositionAudit::follow_search(Instant now) {
  const std::string letter{axis().letter};
  const std::string range = base::to_fixed(kAuditRangeMm, 0) + " mm";
  switch (finder_.verdict()) {
    case SwitchFinder::Verdict::Moving: {
      const double fastest = std::min(plan_.seek_mm_per_min, kCoarseRate * plan_.locate_mm_per_min);
      return go(now, finder_.target(), fastest);
    }
    case SwitchFinder::Verdict::Found:
      found_.at(static_cast<std::size_t>(round_)).push_back(finder_.found());
      return leave(now);
    case SwitchFinder::Verdict::NotFound:
      return end(now, AuditOutcome::Failed,
                 "The switch of " + letter + " did not close within " + range +
                     " behind its place: the machine has lost more than that, was never homed, or the switch does not "
                     "work. Look at the switch, then home the machine ($H).");
    case SwitchFinder::Verdict::StaysShut:
      return end(now, AuditOutcome::Failed,
                 "The switch of " + letter + " stays closed far off its place: look at the switch and its cable.");
    case SwitchFinder::Verdict::Unsteady:
      return end(now, AuditOutcome::Failed,
                 "The switch of " + letter + " closes now here, now there: nothing can be measured with it.");
  }
}

void PositionAudit::leave(Instant now) {
  phase_ = Phase::Leaving;
  const std::int64_t back = std::max<std::int64_t>(1, steps_of(plan_.pull_off_mm));
  const std::int64_t home = finder_.found() - axis().direction * back;
  // Behind homing it ends where homing had left it.
  go(now, round_ == 0 ? home : steps_of(axis().home_mm), plan_.seek_mm_per_min);
}

void PositionAudit::next_axis(Instant now) {
  if (++at_ < plan_.axes.size()) return begin_axis(now);
  if (round_ == 0) return home(now);
  judge(now);
}

void PositionAudit::home(Instant now) {
  note("Homing.");
  phase_ = Phase::Homing;
  at_ = 0;
  is_answered_ = false;
  deadline_ = now + kLongestHoming;
  orders_.emplace_back(AuditHome{});
}

void PositionAudit::judge(Instant now) {
  bool is_shifted = false;
  for (std::size_t i = 0; i < plan_.axes.size(); ++i) {
    AxisAudit& audit = result_.axes.at(i);
    const double steps_per_mm = plan_.axes.at(i).steps_per_mm;
    const auto mm = [steps_per_mm](std::int64_t steps) { return static_cast<double>(steps) / steps_per_mm; };
    const std::int64_t before = found_.at(0).at(i);
    const std::int64_t after = found_.at(1).at(i);
    audit.before_mm = mm(before);
    audit.after_mm = mm(after);
    audit.difference_steps = after - before;
    audit.difference_mm = mm(after - before);
    const bool is_kept = std::abs(*audit.difference_mm) <= result_.tolerance_mm;
    audit.verdict = is_kept ? AxisVerdict::Kept : AxisVerdict::Shifted;
    is_shifted = is_shifted || !is_kept;
  }
  end(now, is_shifted ? AuditOutcome::Shifted : AuditOutcome::Kept,
      is_shifted ? "The machine had lost its position. It is homed now, and knows where it is; what it cut since the "
                   "homing before may be off by as much."
                 : "The machine was where it believed to be.");
}

void PositionAudit::go(Instant now, std::int64_t target, double mm_per_min) {
  const double target_mm = static_cast<double>(target) / axis().steps_per_mm;
  const double at_mm = last_ ? (*last_->machine_position_mm)[axis().index] : target_mm;
  target_ = target;
  is_answered_ = false;
  is_cancelled_ = false;
  deadline_ = now + 2 * travel_time(std::abs(target_mm - at_mm), mm_per_min) + kAllowance;
  orders_.emplace_back(AuditJog{std::string{"G53G21G90"} + axis().letter + base::to_fixed(target_mm, 5) + "F" +
                                base::to_fixed(std::max(1.0, mm_per_min), 0)});
}

void PositionAudit::on_report(Instant now, const machine::Snapshot& snapshot) {
  const bool is_readable = snapshot.machine_position_mm && snapshot.inputs;
  if (phase_ == Phase::Over || !is_readable) return;
  const bool is_first = !last_.has_value();
  last_ = snapshot;
  const bool rests = snapshot.state == MachineState::Idle;
  if (phase_ == Phase::Stopping) {
    if (snapshot.state == MachineState::Alarm || (rests && (is_answered_ || !has_backed_off_))) leave_safely(now);
    return;
  }
  if (phase_ == Phase::Approaching && is_first && rests) return begin_axis(now);
  if (!is_answered_) return;
  if (phase_ == Phase::Homing) {
    if (!rests) return;
    result_.is_homed = true;
    round_ = 1;
    return begin_round(now);
  }
  if (phase_ != Phase::Approaching && phase_ != Phase::Searching && phase_ != Phase::Leaving) return;
  const bool is_closed = snapshot.inputs->limits.contains(axis().letter);
  if (phase_ == Phase::Approaching && is_closed && !is_cancelled_) {
    // The machine stands nearer to the switch than it believes: homing meets switches at this rate, too.
    is_cancelled_ = true;
    if (!rests) orders_.emplace_back(AuditCancelJog{});
  }
  const double at_mm = (*snapshot.machine_position_mm)[axis().index];
  const double off_mm = std::abs(at_mm - static_cast<double>(target_) / axis().steps_per_mm);
  const bool is_there = is_cancelled_ || off_mm <= 0.5 / axis().steps_per_mm + kReportGrainMm;
  if (rests && is_there) arrive(now, is_closed);
}

void PositionAudit::arrive(Instant now, bool is_closed) {
  deadline_ = kNever;
  switch (phase_) {
    case Phase::Approaching: {
      const double at_mm = (*last_->machine_position_mm)[axis().index];
      return begin_search(now, is_cancelled_ ? steps_of(at_mm) : target_, is_closed);
    }
    case Phase::Searching: finder_.on_stand(is_closed); return follow_search(now);
    case Phase::Leaving: return next_axis(now);
    default: return;
  }
}

void PositionAudit::on_settings(Instant now, bool are_written, const std::string& sentence) {
  if (phase_ == Phase::Unprotecting) {
    if (are_written) return begin_round(now);
    // Written or not: what they were is written in the end.
    return end(now, AuditOutcome::Failed, sentence);
  }
  if (phase_ != Phase::Restoring) return;
  if (are_written) {
    are_off_ = false;
  } else {
    result_.sentence += " " + sentence;
  }
  finish();
}

void PositionAudit::on_fault(Instant now, const std::string& sentence) {
  if (phase_ == Phase::Over) return;
  if (phase_ == Phase::Restoring) return on_settings(now, false, sentence);
  if (phase_ == Phase::Stopping) return;
  end(now, AuditOutcome::Failed, sentence);
}

void PositionAudit::on_link_lost(const std::string& sentence) {
  if (phase_ == Phase::Over) return;
  if (phase_ != Phase::Restoring && phase_ != Phase::Stopping) {
    result_.outcome = AuditOutcome::Failed;
    result_.sentence = sentence;
  }
  finish();
}

void PositionAudit::stop(Instant now) {
  if (phase_ == Phase::Over || phase_ == Phase::Restoring || phase_ == Phase::Stopping) return;
  const bool is_homing = phase_ == Phase::Homing;
  if (is_homing) orders_.emplace_back(AuditReset{});
  end(now, AuditOutcome::Stopped,
      is_homing ? "Stopped in the middle of homing: the machine does not know where it is. Home it ($H)."
                : "Stopped before the end: nothing is known about what was lost.");
}

void PositionAudit::end(Instant now, AuditOutcome outcome, std::string sentence) {
  const bool moves = phase_ == Phase::Approaching || phase_ == Phase::Searching || phase_ == Phase::Leaving;
  result_.outcome = outcome;
  result_.sentence = std::move(sentence);
  if (outcome == AuditOutcome::Kept || outcome == AuditOutcome::Shifted) return restore(now);
  if (moves && !(last_ && last_->state == MachineState::Idle && is_answered_)) {
    orders_.emplace_back(AuditCancelJog{});
  }
  phase_ = Phase::Stopping;
  deadline_ = now + kLongestStop;
}

void PositionAudit::leave_safely(Instant now) {
  // On a closed switch hard limits would raise their alarm as soon as they are on again.
  const bool is_closed = last_->inputs->limits.contains(axis().letter);
  if (!is_closed || !are_off_ || has_backed_off_ || last_->state != MachineState::Idle) return restore(now);
  has_backed_off_ = true;
  const std::int64_t at = steps_of((*last_->machine_position_mm)[axis().index]);
  go(now, at - axis().direction * search().back_off, plan_.seek_mm_per_min);
}

void PositionAudit::restore(Instant now) {
  deadline_ = kNever;
  if (!are_off_) return finish();
  phase_ = Phase::Restoring;
  deadline_ = now + kLongestStop;
  orders_.emplace_back(AuditChangeSettings{plan_.protections});
}

void PositionAudit::finish() {
  phase_ = Phase::Over;
  deadline_ = kNever;
  if (!are_off_) return;
  result_.left_off = plan_.protections;
  result_.sentence += " Not as they were, because they could not be put back: " + list_of(plan_.protections) +
                      ". Set them, or let the next audit do it.";
}

void PositionAudit::advance_to(Instant now) {
  if (now < deadline_) return;
  deadline_ = kNever;
  switch (phase_) {
    case Phase::Stopping: return restore(now);
    case Phase::Restoring: return finish();
    case Phase::Homing:
      orders_.emplace_back(AuditReset{});
      return end(now, AuditOutcome::Failed, "Homing has not come to an end within 15 minutes.");
    case Phase::Over:
    case Phase::Unprotecting: return;
    default:
      return end(now, AuditOutcome::Failed,
                 std::string{"The machine does not go where it is sent: "} + axis().letter + " did not arrive.");
  }
}

std::string sentence_of(const AxisAudit& axis) {
  if (!axis.difference_mm || !axis.difference_steps) return axis.axis + " was not measured.";
  const std::int64_t steps = std::abs(*axis.difference_steps);
  if (steps == 0) return axis.axis + " was where it believed to be, to the step.";
  const std::string how_far = base::to_fixed(std::abs(*axis.difference_mm), 3) + " mm (" + std::to_string(steps) +
                              (steps == 1 ? " step)" : " steps)");
  return axis.axis + " stood " + how_far + " farther towards " + (*axis.difference_steps > 0 ? "plus" : "minus") +
         " than it believed" + (axis.verdict == AxisVerdict::Kept ? ", which a switch does by itself." : ".");
}

}  // namespace kerf::job
