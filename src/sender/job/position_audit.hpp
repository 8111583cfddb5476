#pragma once
// Did the machine lose steps? No controller tells: homing sets the position and forgets what it was. But a limit switch
// stays where it is. So Kerf finds the step at which each homing switch closes, has the machine home, and finds it
// again: the difference of the two machine positions is what was lost since the homing before. Sans I/O.
//
// Rejected: watching `$H` itself (Grbl answers no `?` meanwhile, all three count from zero in it), and comparing with
// the place where the settings say that the switch is (it closes a little earlier or later, depending on the speed).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "common/base/time.hpp"
#include "sender/job/audit_plan.hpp"
#include "sender/job/switch_finder.hpp"
#include "sender/machine/settings_plan.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

enum class AxisVerdict {
  NotMeasured,
  Kept,     ///< the difference is no larger than what a switch does by itself
  Shifted,  ///< the machine is not where it believed to be
};
BOOST_DESCRIBE_ENUM(AxisVerdict, NotMeasured, Kept, Shifted)

/// What was found out about one axis.
struct AxisAudit {
  std::string axis{};
  AxisVerdict verdict = AxisVerdict::NotMeasured;
  /// Where the machine really stood, less where it believed to stand: above zero, it stood farther towards plus.
  std::optional<double> difference_mm{};
  std::optional<std::int64_t> difference_steps{};
  /// Machine positions at which the switch closed, before and behind homing.
  std::optional<double> before_mm{};
  std::optional<double> after_mm{};
  /// The length of a step, which is the resolution.
  double step_mm = 0;
};
BOOST_DESCRIBE_STRUCT(AxisAudit, (), (axis, verdict, difference_mm, difference_steps, before_mm, after_mm, step_mm))

enum class AuditOutcome {
  Unfinished,  ///< under way, or cut off
  Kept,        ///< all axes are where they believed to be
  Shifted,     ///< at least one is not
  Failed,      ///< it could not be measured
  Stopped,     ///< by the operator
};
BOOST_DESCRIBE_ENUM(AuditOutcome, Unfinished, Kept, Shifted, Failed, Stopped)

struct AuditResult {
  AuditOutcome outcome = AuditOutcome::Unfinished;
  std::string sentence{};
  std::vector<AxisAudit> axes{};
  double tolerance_mm = 0;
  /// The machine was homed by it, and knows where it is now.
  bool is_homed = false;
  /// Settings that are still off, and what they were.
  std::vector<machine::SettingAssignment> left_off{};
};
BOOST_DESCRIBE_STRUCT(AuditResult, (), (outcome, sentence, axes, tolerance_mm, is_homed, left_off))

/// A jog with these words.
struct AuditJog {
  std::string words;
};
struct AuditCancelJog {};
struct AuditHome {};
/// Homing is to end at once: only a reset does it.
struct AuditReset {};
struct AuditChangeSettings {
  std::vector<machine::SettingAssignment> settings;
};
/// For the operator.
struct AuditNote {
  std::string sentence;
};
using AuditOrder = std::variant<AuditJog, AuditCancelJog, AuditHome, AuditReset, AuditChangeSettings, AuditNote>;

/// A mechanical switch repeats to a few hundredths of a millimetre; a stepper that slips loses four full steps at once,
/// which is 0.1 mm on a screw of 5 mm lead and more on a belt.
inline constexpr double kAuditToleranceMm = 0.05;

class PositionAudit {
 public:
  PositionAudit(Instant now, AuditPlan plan, double tolerance_mm = kAuditToleranceMm);

  void on_report(Instant now, const machine::Snapshot& snapshot);
  /// The line that was ordered last was taken.
  void on_ok() { is_answered_ = true; }
  /// An alarm, a refused line or command, a restart: one sentence says what.
  void on_fault(Instant now, const std::string& sentence);
  /// The settings that were ordered are written, or else why not.
  void on_settings(Instant now, bool are_written, const std::string& sentence);
  /// Nothing more will come.
  void on_link_lost(const std::string& sentence);
  /// The operator has had enough.
  void stop(Instant now);
  void advance_to(Instant now);

  [[nodiscard]] Instant next_deadline() const { return deadline_; }
  [[nodiscard]] std::vector<AuditOrder> take_orders();
  [[nodiscard]] bool is_over() const { return phase_ == Phase::Over; }
  [[nodiscard]] const AuditResult& result() const { return result_; }

 private:
  enum class Phase { Unprotecting, Approaching, Searching, Leaving, Homing, Stopping, Restoring, Over };

  [[nodiscard]] const AuditAxis& axis() const { return plan_.axes.at(at_); }
  [[nodiscard]] std::int64_t steps_of(double mm) const;
  [[nodiscard]] SwitchSearch search() const;
  void note(std::string sentence) { orders_.emplace_back(AuditNote{std::move(sentence)}); }
  void begin_round(Instant now);
  void begin_axis(Instant now);
  void begin_search(Instant now, std::int64_t at, bool is_closed);
  void follow_search(Instant now);
  void leave(Instant now);
  void next_axis(Instant now);
  void home(Instant now);
  void judge(Instant now);
  void go(Instant now, std::int64_t target, double mm_per_min);
  void arrive(Instant now, bool is_closed);
  void end(Instant now, AuditOutcome outcome, std::string sentence);
  void leave_safely(Instant now);
  void restore(Instant now);
  void finish();

  AuditPlan plan_;
  Phase phase_ = Phase::Unprotecting;
  /// 0 before homing, 1 behind it.
  int round_ = 0;
  std::size_t at_ = 0;
  SwitchFinder finder_;
  std::optional<machine::Snapshot> last_;
  std::int64_t target_ = 0;
  bool is_answered_ = false;
  bool is_cancelled_ = false;
  /// Off a closed switch, before the end.
  bool has_backed_off_ = false;
  bool are_off_ = false;
  Instant deadline_ = kNever;
  /// Of each axis, in each round.
  std::vector<std::vector<std::int64_t>> found_{{}, {}};
  std::vector<AuditOrder> orders_;
  AuditResult result_;
};

/// "X stood 0.160 mm (40 steps) farther towards minus than it believed." and so on.
[[nodiscard]] std::string sentence_of(const AxisAudit& axis);

}  // namespace kerf::job
