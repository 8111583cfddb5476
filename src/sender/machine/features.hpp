#pragma once
// What a controller can do beyond cutting, concluded from `$I`, `$$` and `$#`: every fact with its source.

#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

namespace kerf::machine {

/// Where a fact comes from: the controller said it, Kerf concludes it from something that it said, or Kerf assumes the
/// safe case.
enum class FactSource { Assumed, Inferred, Told };
BOOST_DESCRIBE_ENUM(FactSource, Assumed, Inferred, Told)

/// Something that a controller has, has not, or does not tell. `detail` says more in words.
struct FeatureFact {
  std::optional<bool> available{};
  std::string detail{};
  FactSource source = FactSource::Assumed;
  bool operator==(const FeatureFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(FeatureFact, (), (available, detail, source))

/// A letter of `[OPT:]` or a token of `[NEWOPT:]`, and what it means.
struct OptionFact {
  std::string key{};
  std::string value{};
  std::string name{};
  std::string text{};
  FactSource source = FactSource::Told;
  bool operator==(const OptionFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(OptionFact, (), (key, value, name, text, source))

/// A row of `$SPINDLESH`; `flags` are the controller's letters, of which `*` marks the one in use.
struct SpindleFact {
  int id = 0;
  std::optional<int> number{};
  std::optional<int> type{};
  std::string flags{};
  std::string name{};
  std::optional<double> min_rpm{};
  std::optional<double> max_rpm{};
  FactSource source = FactSource::Assumed;
  bool operator==(const SpindleFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(SpindleFact, (), (id, number, type, flags, name, min_rpm, max_rpm, source))

/// The homing cycle as `$22` and the phases have it.
struct HomingFact {
  std::optional<bool> enabled{};
  std::optional<bool> single_axis{};
  std::optional<bool> required_at_start{};
  std::optional<bool> sets_origin{};
  /// Axes of each phase, in order: "Z", "XY".
  std::vector<std::string> phases;
  FactSource source = FactSource::Assumed;
  FactSource phases_source = FactSource::Assumed;
  bool operator==(const HomingFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(HomingFact, (),
                      (enabled, single_axis, required_at_start, sets_origin, phases, source, phases_source))

/// What `M6` does.
enum class ToolChangeKind {
  Unknown,
  None,     ///< M6 is refused
  Ignored,  ///< M6 is accepted and does nothing
  Manual,   ///< the controller waits for the operator
  Changer,  ///< a tool changer is on line
};
BOOST_DESCRIBE_ENUM(ToolChangeKind, Unknown, None, Ignored, Manual, Changer)

struct ToolChangeFact {
  ToolChangeKind kind = ToolChangeKind::Unknown;
  /// The controller's word for its mode (`$341`).
  std::string mode{};
  FactSource source = FactSource::Assumed;
  bool operator==(const ToolChangeFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(ToolChangeFact, (), (kind, mode, source))

/// `[AUX IO:din,dout,ain,aout]`
struct AuxPortsFact {
  int digital_inputs = 0;
  int digital_outputs = 0;
  int analog_inputs = 0;
  int analog_outputs = 0;
  FactSource source = FactSource::Assumed;
  bool operator==(const AuxPortsFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(AuxPortsFact, (), (digital_inputs, digital_outputs, analog_inputs, analog_outputs, source))

/// A network service and its port.
struct NetworkPortFact {
  std::string service{};
  int port = 0;
  FactSource source = FactSource::Assumed;
  bool operator==(const NetworkPortFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(NetworkPortFact, (), (service, port, source))

/// What a setting selects, as a word: the mode of operation, the units of reports.
struct WordFact {
  std::string word{};
  FactSource source = FactSource::Assumed;
  bool operator==(const WordFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(WordFact, (), (word, source))

struct NamesFact {
  std::vector<std::string> names;
  FactSource source = FactSource::Assumed;
  bool operator==(const NamesFact&) const = default;
};
BOOST_DESCRIBE_STRUCT(NamesFact, (), (names, source))

/// All of it. The member names are keys of `kerf info --json`.
struct Features {
  /// "Normal", "Laser mode", "Lathe mode", in the controller's words (`$32`).
  WordFact mode;
  /// "mm" or "inch": the units of positions and feeds in reports (`$13`).
  WordFact report_units;
  /// What status reports hold (`$10`), in the controller's words.
  NamesFact report_contents;
  HomingFact homing;
  FeatureFact soft_limits;
  FeatureFact hard_limits;
  FeatureFact probe;
  /// Numbers of the probe inputs.
  std::vector<int> probes;
  ToolChangeFact tool_change;
  FeatureFact sd_card;
  FeatureFact file_transfer;
  FeatureFact pendant;
  FeatureFact laser;
  FeatureFact lathe;
  FeatureFact spindle_sync;
  FeatureFact safety_door;
  FeatureFact emergency_stop;
  FeatureFact expressions;
  FeatureFact reboot;
  /// `?`, `!` and `~` act at once in texts too; false: they may be part of a setting.
  FeatureFact legacy_realtime;
  AuxPortsFact aux_ports;
  std::vector<NetworkPortFact> network;
  /// G54 … as `$#` lists them.
  NamesFact coordinate_systems;
  bool operator==(const Features&) const = default;
};
BOOST_DESCRIBE_STRUCT(Features, (),
                      (mode, report_units, report_contents, homing, soft_limits, hard_limits, probe, probes,
                       tool_change, sd_card, file_transfer, pendant, laser, lathe, spindle_sync, safety_door,
                       emergency_stop, expressions, reboot, legacy_realtime, aux_ports, network, coordinate_systems))

struct Capabilities;

/// What follows from the rows, tokens and settings that `known` holds already.
[[nodiscard]] Features features_of(const Capabilities& known, const std::vector<std::string>& coordinate_systems);

/// The meaning of each letter of `[OPT:]` and each token of `[NEWOPT:]`.
[[nodiscard]] std::vector<OptionFact> explain_options(const Capabilities& known);

/// `[SPINDLE:0|0|0|*DRV|simulated PWM spindle|0.0,1000.0]`, without its frame.
[[nodiscard]] std::optional<SpindleFact> read_spindle_row(std::string_view text);
/// `0 - simulated PWM spindle, enabled as spindle 0, active` of `$SPINDLES`.
[[nodiscard]] std::optional<SpindleFact> read_spindle_line(std::string_view line);

}  // namespace kerf::machine
