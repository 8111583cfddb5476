#pragma once
// Gathers what a controller says about itself into Capabilities.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/protocol/message.hpp"
#include "common/vocabulary/dialect.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/lexicon.hpp"

namespace kerf::machine {

/// Fed with every message of a handshake; answers what is known so far. The firmware family follows from the most
/// specific evidence: `[FIRMWARE:]` and `[NEWOPT:]`, then the welcome, then the shape of `[VER:]` and `[OPT:]`
/// (protocol.md 1.6).
class CapabilityCollector {
 public:
  void fold(const protocol::Message& message);
  void forget();

  [[nodiscard]] vocabulary::Firmware family() const;
  [[nodiscard]] const vocabulary::Dialect& dialect() const { return vocabulary::dialect_of(family()); }
  [[nodiscard]] bool has_token(std::string_view token) const;
  [[nodiscard]] const Lexicon& lexicon() const { return lexicon_; }

  [[nodiscard]] Capabilities capabilities(bool complete) const;
  /// The setting's id as it is known here: Rabbit's "X/MaxRate" is "110", "Homing/Squared" has a name only.
  [[nodiscard]] std::string id_of(std::string_view id) const;
  /// The same text as long as the controller runs the same firmware with the same options; empty while it is not known.
  [[nodiscard]] std::string identity() const;
  /// It has settings that it describes, and one with a value is not described.
  [[nodiscard]] bool has_undescribed_value() const;
  [[nodiscard]] bool knows_spindles() const { return !spindles_.empty(); }

 private:
  [[nodiscard]] FactSource family_source() const;
  [[nodiscard]] AxesFact axes() const;
  [[nodiscard]] BuffersFact buffers() const;
  [[nodiscard]] std::vector<std::string> tokens() const;
  [[nodiscard]] std::vector<SettingFact> settings() const;
  [[nodiscard]] SettingFact describe_setting(const std::string& id) const;
  [[nodiscard]] SettingFact describe_from_table(const std::string& id) const;
  [[nodiscard]] std::vector<SettingGroupFact> groups() const;
  void fold_value(const protocol::SettingValue& value);
  void fold_build_row(const protocol::BuildRow& row);
  void fold_table_row(const protocol::SettingTableRow& row);
  void fold_other(const std::string& line);
  void fold_offset(const std::string& name);

  std::optional<protocol::Welcome> welcome_;
  std::optional<protocol::Version> version_;
  std::optional<protocol::BuildOptions> options_;
  std::optional<protocol::AxisNames> axis_names_;
  std::optional<protocol::NewOptions> new_options_;
  std::string firmware_name_;
  std::vector<BuildFact> build_rows_;
  std::map<int, protocol::SettingGroupRow> groups_;
  std::map<int, protocol::SettingDefinition> definitions_;
  std::map<int, std::string> helps_;
  /// The row of `$ESH` whose description may go on in the next line.
  std::optional<protocol::SettingTableRow> open_row_;
  std::vector<SpindleFact> spindles_;
  std::vector<std::string> coordinate_systems_;
  /// In the order in which `$$` lists them.
  std::vector<protocol::SettingValue> values_;
  /// Axes of the last position seen, where `$I` does not tell.
  int axes_seen_ = 0;
  Lexicon lexicon_;
};

/// "grblHAL 1.1f (build 20260817), axes XYZ, 1024 bytes of receive buffer, 100 planner blocks"
[[nodiscard]] std::string summary_of(const Capabilities& capabilities);

}  // namespace kerf::machine
