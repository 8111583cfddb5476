#pragma once
// Whether and how a machine's position can be audited (position_audit.hpp), from what it says about itself. Pure.

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "sender/machine/capabilities.hpp"
#include "sender/machine/settings_plan.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

/// An axis with a homing switch.
struct AuditAxis {
  char letter = 'X';
  /// Place in the machine's positions.
  std::size_t index = 0;
  /// +1 or -1: where its switch is.
  int direction = 1;
  double steps_per_mm = 0;
  /// Where it stands behind homing; the switch is one pull-off farther.
  double home_mm = 0;
};

struct AuditPlan {
  /// In the order in which they are measured: Z first.
  std::vector<AuditAxis> axes{};
  double pull_off_mm = 0;
  /// Rates at which homing looks for the switches, and meets them again.
  double seek_mm_per_min = 0;
  double locate_mm_per_min = 0;
  /// What would stop the machine at its switches, and is off meanwhile; and as it is to be afterwards.
  std::vector<machine::SettingAssignment> protections_off{};
  std::vector<machine::SettingAssignment> protections{};
  /// The controller itself says that the machine was homed; else nobody can know it.
  bool is_known_homed = false;
};

/// So far before and behind the expected place a switch is looked for.
inline constexpr double kAuditRangeMm = 3;

/// `letters`: only these axes and Z, as "XZ"; empty for all that home. `left_off`: what an audit that was cut off could
/// not put back. The error is one sentence that says why the machine cannot be measured.
[[nodiscard]] std::expected<AuditPlan, std::string> plan_audit(
    const machine::Capabilities& machine, const machine::Snapshot& now, std::string_view letters = {},
    const std::vector<machine::SettingAssignment>& left_off = {});

}  // namespace kerf::job
