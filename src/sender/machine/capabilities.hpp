#pragma once
// What the connected controller can do: one value, with a source for every fact.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"
#include "sender/machine/features.hpp"

namespace kerf::machine {

struct AxesFact {
  int count = 3;
  std::string letters = "XYZ";
  FactSource source = FactSource::Assumed;
  bool operator==(const AxesFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(AxesFact, (), (count, letters, source))

struct BuffersFact {
  /// Receive buffer as the controller states it; a sender keeps one byte less in flight (protocol.md 6.1).
  int rx_bytes = 0;
  /// Bytes that a sender may have unanswered.
  int rx_usable = 0;
  FactSource rx_source = FactSource::Assumed;
  int planner_blocks = 0;
  FactSource planner_source = FactSource::Assumed;
  /// Longest line the controller takes, without its line end.
  int line_length = 0;
  FactSource line_source = FactSource::Assumed;
  bool operator==(const BuffersFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(BuffersFact, (),
                      (rx_bytes, rx_usable, rx_source, planner_blocks, planner_source, line_length, line_source))

/// An alarm or error code with its meaning, in the controller's words when it has any.
struct CodeFact {
  int id = 0;
  std::string title{};
  std::string text{};
  FactSource source = FactSource::Assumed;
  bool operator==(const CodeFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(CodeFact, (), (id, title, text, source))

/// A setting: its value as printed by `$$`, and what is known about it. `id` is printed without `$` ("110",
/// "Homing/Enable").
struct SettingFact {
  std::string id{};
  std::optional<std::string> value{};
  std::string name{};
  std::string unit{};
  /// -1 when unknown; see Capabilities::setting_groups.
  int group_id = -1;
  std::string group{};
  /// Type code of protocol.md 5.2; -1 when unknown.
  int type = -1;
  /// The type in words: "Bool", "Bitfield", "Text" …; empty when unknown.
  std::string type_name{};
  std::string format{};
  std::string min{};
  std::string max{};
  bool reboot_required = false;
  bool allow_null = false;
  /// What it does. Lines are separated by a line feed.
  std::string help{};
  FactSource help_source = FactSource::Assumed;
  /// Source of the description; the value is always told.
  FactSource source = FactSource::Assumed;
  bool operator==(const SettingFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(SettingFact, (),
                      (id, value, name, unit, group_id, group, type, type_name, format, min, max, reboot_required,
                       allow_null, help, help_source, source))

/// A row of `$EG`.
struct SettingGroupFact {
  int id = 0;
  int parent = 0;
  std::string name{};
  FactSource source = FactSource::Assumed;
  bool operator==(const SettingGroupFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(SettingGroupFact, (), (id, parent, name, source))

/// One other row of `$I`, as `[KEY:value]`.
struct BuildFact {
  std::string key{};
  std::string value{};
  bool operator==(const BuildFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(BuildFact, (), (key, value))

/// Capabilities of the controller on the other end. The member names are the keys of `kerf info --json`.
struct Capabilities {
  /// Name that people use: "Grbl", "Rabbit GRBL", "grblHAL", "unknown firmware".
  std::string firmware = "unknown firmware";
  vocabulary::Firmware family = vocabulary::Firmware::Unknown;
  FactSource firmware_source = FactSource::Assumed;
  /// "1.1h", "1.6.0", "1.1f".
  std::string version{};
  /// Build date, as in `[VER:1.1f.20260817:]`.
  std::string build{};
  std::string welcome{};
  /// The text that the owner stored with `$I=`.
  std::string user_text{};
  /// Letters of `[OPT:]`.
  std::string options{};
  /// Tokens of `[NEWOPT:]`, and what Kerf concludes without them.
  std::vector<std::string> capabilities;
  /// The controller printed a `[NEWOPT:]`: what it does not list, it does not have.
  bool lists_tokens = false;
  AxesFact axes;
  BuffersFact buffers;
  std::optional<int> tools{};
  std::vector<BuildFact> build_rows;
  /// False when a question of the enumeration stayed without an answer.
  bool complete = false;
  std::vector<CodeFact> alarms;
  std::vector<CodeFact> errors;
  std::vector<SettingFact> settings;
  std::vector<SettingGroupFact> setting_groups;
  std::vector<SpindleFact> spindles;
  std::vector<OptionFact> option_meanings;
  Features features;

  /// True for a token with or without a value: has("ATC") for "ATC=1".
  [[nodiscard]] bool has(std::string_view token) const;
  /// The setting with this id ("110", "Homing/Squared") or name (Rabbit: "X/MaxRate" is "110"), or nothing.
  [[nodiscard]] const SettingFact* find_setting(std::string_view id) const;
  bool operator==(const Capabilities&) const = default;
};
BOOST_DESCRIBE_STRUCT(Capabilities, (),
                      (firmware, family, firmware_source, version, build, welcome, user_text, options, capabilities,
                       lists_tokens, axes, buffers, tools, build_rows, complete, alarms, errors, settings,
                       setting_groups, spindles, option_meanings, features))

}  // namespace kerf::machine
