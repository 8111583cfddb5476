#pragma once
// Several settings at once: what would change, in which order, and whether all of it would be taken. Pure.

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "sender/machine/capabilities.hpp"
#include "sender/machine/setting_value.hpp"

namespace kerf::machine {

/// `$110=500`: as a person or a file gives it. `id` is "110" or "Homing/Enable".
struct SettingAssignment {
  std::string id{};
  std::string value{};
  bool operator==(const SettingAssignment&) const = default;
};
BOOST_DESCRIBE_STRUCT(SettingAssignment, (), (id, value))

/// A value that differs. Empty texts are values too; `known_before` is false where the machine did not have it.
struct SettingDifference {
  std::string id{};
  std::string name{};
  std::string unit{};
  std::string before{};
  std::string after{};
  bool known_before = true;
  bool known_after = true;
  bool reboot_required = false;
  bool operator==(const SettingDifference&) const = default;
};
BOOST_DESCRIBE_STRUCT(SettingDifference, (),
                      (id, name, unit, before, after, known_before, known_after, reboot_required))

/// What to write, in order: settings that others need come first (`$22` before `$20`).
struct SettingsPlan {
  std::vector<SettingDifference> steps;
};

/// Checks all assignments against what the machine says of itself and against each other; all refusals if there is any.
/// The last assignment of a setting counts; values that are set already are left out.
[[nodiscard]] std::expected<SettingsPlan, std::vector<SettingRefusal>> plan_settings(
    const Capabilities& machine, const std::vector<SettingAssignment>& wanted);

/// The steps in an order in which they can be written.
[[nodiscard]] std::vector<SettingDifference> in_writing_order(vocabulary::Firmware firmware,
                                                              std::vector<SettingDifference> steps);

/// The settings of the machine as assignments, in the order in which it lists them.
[[nodiscard]] std::vector<SettingAssignment> settings_of(const Capabilities& machine);

/// What differs from `before` to `after`; `machine` knows names and which values mean the same. Passwords are stars and
/// never compared.
[[nodiscard]] std::vector<SettingDifference> differences(const Capabilities& machine,
                                                         const std::vector<SettingAssignment>& before,
                                                         const std::vector<SettingAssignment>& after);

/// "$110 (X-axis maximum rate): 500 -> 600 mm/min"
[[nodiscard]] std::string sentence_of(const SettingDifference& difference);

}  // namespace kerf::machine
