#include "sender/machine/features.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/base/text.hpp"
#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/options.hpp"
#include "sender/machine/capabilities.hpp"

namespace kerf::machine {
namespace {

using vocabulary::Dialect;
using vocabulary::SettingType;

constexpr unsigned kMostItems = 32;

/// A fact that nobody tells: on a known firmware it follows from which one it is.
FactSource untold(const Dialect& dialect) {
  return dialect.firmware == vocabulary::Firmware::Unknown ? FactSource::Assumed : FactSource::Inferred;
}

std::optional<unsigned> number_of(const Capabilities& known, std::string_view id) {
  const SettingFact* setting = known.find_setting(id);
  if (setting == nullptr || !setting->value) return std::nullopt;
  return base::parse_int<unsigned>(base::trim(*setting->value));
}

bool is_type(const Capabilities& known, std::string_view id, SettingType type) {
  const SettingFact* setting = known.find_setting(id);
  return setting != nullptr && setting->type == static_cast<int>(type);
}

std::string_view item_of(const Capabilities& known, std::string_view id, unsigned index) {
  const SettingFact* setting = known.find_setting(id);
  if (setting == nullptr || index >= kMostItems) return {};
  return vocabulary::item_of(setting->format, static_cast<int>(index));
}

std::string letters_of(const Capabilities& known, unsigned mask) {
  std::string letters;
  for (std::size_t axis = 0; axis < known.axes.letters.size() && axis < kMostItems; ++axis) {
    if ((mask >> axis & 1U) != 0) letters += known.axes.letters[axis];
  }
  return letters;
}

/// The value of a token: "1" of `ATC=1`; nothing if it is not there.
std::optional<std::string> token_value(const Capabilities& known, std::string_view token) {
  for (const std::string& text : known.capabilities) {
    const auto equals = text.find('=');
    if (std::string_view{text}.substr(0, equals) != token) continue;
    return equals == std::string::npos ? std::string{} : text.substr(equals + 1);
  }
  return std::nullopt;
}

/// What a controller with `[NEWOPT:]` has or has not; without that row only a known firmware tells.
FeatureFact by_token(const Capabilities& known, std::initializer_list<std::string_view> tokens) {
  const bool lists_tokens = known.lists_tokens;
  for (const std::string_view token : tokens) {
    if (!token_value(known, token)) continue;
    const auto* row = vocabulary::find_new_option(token);
    return {.available = true,
            .detail = row == nullptr ? std::string{} : std::string{row->name},
            .source = lists_tokens ? FactSource::Told : FactSource::Inferred};
  }
  if (lists_tokens) return {.available = false, .detail = {}, .source = FactSource::Inferred};
  if (known.family == vocabulary::Firmware::Unknown) return {};
  return {.available = false, .detail = {}, .source = FactSource::Inferred};
}

FeatureFact by_setting(const Capabilities& known, std::string_view id, unsigned bit = 0) {
  const auto value = number_of(known, id);
  if (!value) return {};
  return {.available = (*value >> bit & 1U) != 0, .detail = "$" + std::string{id}, .source = FactSource::Told};
}

WordFact mode_of(const Capabilities& known) {
  const auto value = number_of(known, "32");
  if (!value) return {.word = "Normal", .source = FactSource::Assumed};
  const std::string_view word = item_of(known, "32", *value);
  if (is_type(known, "32", SettingType::Radio) && !word.empty()) {
    return {.word = std::string{word}, .source = FactSource::Told};
  }
  return {.word = *value == 0 ? "Normal" : "Laser mode", .source = FactSource::Told};
}

NamesFact report_contents_of(const Capabilities& known) {
  const auto mask = number_of(known, "10");
  if (!mask) return {};
  NamesFact fact{.names = {}, .source = FactSource::Told};
  for (unsigned bit = 0; bit < kMostItems; ++bit) {
    const std::string_view item = item_of(known, "10", bit);
    if ((*mask >> bit & 1U) != 0 && !item.empty()) fact.names.emplace_back(item);
  }
  return fact;
}

/// Bits of grblHAL's `$22`; elsewhere it is a yes or no (protocol.md 7.3).
void read_homing_bits(const Capabilities& known, unsigned value, HomingFact& homing) {
  constexpr unsigned kSingleAxis = 1;
  constexpr unsigned kRequired = 2;
  constexpr unsigned kSetsOrigin = 3;
  homing.enabled = (value & 1U) != 0;
  if (!is_type(known, "22", SettingType::ExclusiveBitfield)) return;
  homing.single_axis = (value >> kSingleAxis & 1U) != 0;
  homing.required_at_start = (value >> kRequired & 1U) != 0;
  homing.sets_origin = (value >> kSetsOrigin & 1U) != 0;
}

HomingFact homing_of(const Capabilities& known, const Dialect& dialect) {
  HomingFact homing;
  if (const auto value = number_of(known, "22")) {
    homing.source = FactSource::Told;
    read_homing_bits(known, *value, homing);
  }
  if (!homing.single_axis && !known.options.empty()) homing.single_axis = known.options.contains('H');
  for (int phase = 0; phase < dialect.homing_phase_count; ++phase) {
    const auto mask = number_of(known, std::to_string(dialect.homing_phase_setting + phase));
    if (!mask) continue;
    homing.phases_source = FactSource::Told;
    if (*mask != 0) homing.phases.push_back(letters_of(known, *mask));
  }
  if (homing.phases_source != FactSource::Told && !dialect.homing_phases.empty()) {
    for (const std::string_view phase : base::split(dialect.homing_phases, ',')) homing.phases.emplace_back(phase);
    homing.phases_source = untold(dialect);
  }
  return homing;
}

void add_probes(const Capabilities& known, const Dialect& dialect, Features& features) {
  if (token_value(known, "NOPROBE")) {
    features.probe = {.available = false, .detail = "NOPROBE", .source = FactSource::Told};
    return;
  }
  const std::string detail = token_value(known, "PC") ? "the controller knows whether it is plugged in" : "";
  if (const auto mask = base::parse_int<unsigned>(token_value(known, "PROBES").value_or(""))) {
    features.probe = {.available = *mask != 0, .detail = detail, .source = FactSource::Told};
    for (unsigned probe = 0; probe < kMostItems; ++probe) {
      if ((*mask >> probe & 1U) != 0) features.probes.push_back(static_cast<int>(probe));
    }
    return;
  }
  // All three have an input for a probe unless they say otherwise.
  if (dialect.firmware == vocabulary::Firmware::Unknown) return;
  features.probe = {.available = true, .detail = detail, .source = FactSource::Inferred};
  features.probes = {0};
}

ToolChangeFact tool_change_of(const Capabilities& known, const Dialect& dialect) {
  ToolChangeFact fact;
  if (const auto mode = number_of(known, "341")) fact.mode = std::string{item_of(known, "341", *mode)};
  const auto changer = token_value(known, "ATC");
  if (changer && *changer != "0") {
    fact.kind = ToolChangeKind::Changer;
    fact.source = FactSource::Told;
  } else if (token_value(known, "TC")) {
    fact.kind = ToolChangeKind::Manual;
    fact.source = FactSource::Told;
  } else if (!fact.mode.empty()) {
    // `TC` goes when $341 says that M6 is ignored (protocol.md 4.6).
    fact.kind = ToolChangeKind::Ignored;
    fact.source = FactSource::Inferred;
  } else if (dialect.tool_change == vocabulary::ToolChangeRule::Refused) {
    fact.kind = ToolChangeKind::None;
    fact.source = FactSource::Inferred;
  } else if (dialect.tool_change == vocabulary::ToolChangeRule::Ignored) {
    fact.kind = ToolChangeKind::Ignored;
    fact.source = FactSource::Inferred;
  }
  return fact;
}

FeatureFact signal_of(const Capabilities& known, char letter, std::string_view option) {
  for (const BuildFact& row : known.build_rows) {
    if (row.key == "SIGNALS") {
      return {
          .available = row.value.contains(letter), .detail = "[SIGNALS:" + row.value + "]", .source = FactSource::Told};
    }
  }
  if (!option.empty() && known.options.contains(option)) {
    return {.available = true, .detail = "[OPT:]", .source = FactSource::Told};
  }
  return {};
}

AuxPortsFact aux_ports_of(const Capabilities& known) {
  for (const BuildFact& row : known.build_rows) {
    if (row.key != "AUX IO") continue;
    const auto numbers = base::split(row.value, ',');
    const auto number = [&](std::size_t index) {
      return index < numbers.size() ? base::parse_int(base::trim(numbers[index])).value_or(0) : 0;
    };
    return {number(0), number(1), number(2), number(3), FactSource::Told};
  }
  return {};
}

std::vector<NetworkPortFact> network_of(const Capabilities& known, const Dialect& dialect) {
  // Ids of the first interface of grblHAL (protocol.md 7.4).
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kPorts{
      {{"305", "telnet"}, {"306", "http"}, {"307", "websocket"}, {"308", "ftp"}}};
  std::vector<NetworkPortFact> ports;
  for (const auto& [id, service] : kPorts) {
    const auto port = number_of(known, id);
    if (port) ports.push_back({std::string{service}, static_cast<int>(*port & 0xFFFFU), FactSource::Told});
  }
  const bool has_network = number_of(known, "73").value_or(0) != 0;
  if (ports.empty() && has_network && dialect.ports.telnet != 0) {
    ports.push_back({"telnet", dialect.ports.telnet, FactSource::Inferred});
  }
  return ports;
}

FeatureFact legacy_realtime_of(const Capabilities& known) {
  if (token_value(known, "RT-")) return {.available = false, .detail = "$39", .source = FactSource::Told};
  if (token_value(known, "RT+")) return {.available = true, .detail = "$39", .source = FactSource::Told};
  if (number_of(known, "39") && known.lists_tokens) return by_setting(known, "39");
  return {.available = true,
          .detail = {},
          .source = known.family == vocabulary::Firmware::Unknown ? FactSource::Assumed : FactSource::Inferred};
}

}  // namespace

Features features_of(const Capabilities& known, const std::vector<std::string>& coordinate_systems) {
  const Dialect& dialect = vocabulary::dialect_of(known.family);
  Features features;
  features.mode = mode_of(known);
  if (const auto inches = number_of(known, "13")) {
    features.report_units = {.word = *inches == 0 ? "mm" : "inch", .source = FactSource::Told};
  } else {
    features.report_units = {.word = "mm", .source = FactSource::Assumed};
  }
  features.report_contents = report_contents_of(known);
  features.homing = homing_of(known, dialect);
  features.soft_limits = by_setting(known, "20");
  features.hard_limits = by_setting(known, "21");
  add_probes(known, dialect, features);
  features.tool_change = tool_change_of(known, dialect);
  features.sd_card = by_token(known, {"SD", "FS"});
  features.file_transfer = by_token(known, {"YM", "FTP"});
  features.pendant = by_token(known, {"MPG"});
  features.laser = features.mode.source == FactSource::Told
                       ? FeatureFact{.available = true, .detail = "$32", .source = FactSource::Inferred}
                       : FeatureFact{};
  features.lathe = by_token(known, {"LATHE", "LATHEUVW"});
  const bool can_be_lathe = is_type(known, "32", SettingType::Radio) && known.find_setting("32")->format.contains(',');
  if (features.lathe.available == false && can_be_lathe && !item_of(known, "32", 2).empty()) {
    features.lathe = {.available = true, .detail = "$32=2", .source = FactSource::Told};
  }
  features.spindle_sync = by_token(known, {"SS"});
  features.safety_door = signal_of(known, 'D', "+");
  features.emergency_stop = signal_of(known, 'E', "");
  if (!features.emergency_stop.available) features.emergency_stop = by_token(known, {"ES"});
  features.expressions = by_token(known, {"EXPR"});
  features.reboot = by_token(known, {"REBOOT"});
  features.legacy_realtime = legacy_realtime_of(known);
  features.aux_ports = aux_ports_of(known);
  features.network = network_of(known, dialect);
  features.coordinate_systems = {.names = coordinate_systems,
                                 .source = coordinate_systems.empty() ? FactSource::Assumed : FactSource::Told};
  return features;
}

std::vector<OptionFact> explain_options(const Capabilities& known) {
  std::vector<OptionFact> facts;
  for (const char letter : known.options) {
    OptionFact fact{.key = std::string{letter}};
    if (const auto* row = vocabulary::find_option(known.family, letter)) {
      fact.name = row->name;
      fact.text = row->text;
    }
    facts.push_back(std::move(fact));
  }
  for (const std::string& token : known.capabilities) {
    const auto equals = token.find('=');
    OptionFact fact{.key = token.substr(0, equals),
                    .value = equals == std::string::npos ? std::string{} : token.substr(equals + 1)};
    fact.source = known.lists_tokens ? FactSource::Told : FactSource::Inferred;
    if (const auto* row = vocabulary::find_new_option(token)) {
      fact.name = row->name;
      fact.text = row->text;
    }
    facts.push_back(std::move(fact));
  }
  return facts;
}

// 0|0|0|*DRV|simulated PWM spindle|0.0,1000.0
std::optional<SpindleFact> read_spindle_row(std::string_view text) {
  const auto parts = base::split(text, '|');
  constexpr std::size_t kParts = 5;
  if (parts.size() < kParts) return std::nullopt;
  const auto id = base::parse_int(parts[0]);
  if (!id) return std::nullopt;
  SpindleFact spindle{.id = *id,
                      .number = base::parse_int(parts[1]),
                      .type = base::parse_int(parts[2]),
                      .flags = std::string{parts[3]},
                      .name = std::string{parts[4]},
                      .source = FactSource::Told};
  if (parts.size() == kParts) return spindle;
  const auto range = base::split(parts[kParts], ',');
  spindle.min_rpm = base::parse_decimal(range.front());
  if (range.size() > 1) spindle.max_rpm = base::parse_decimal(range[1]);
  return spindle;
}

// 0 - simulated PWM spindle, enabled as spindle 0, active
std::optional<SpindleFact> read_spindle_line(std::string_view line) {
  constexpr std::string_view kActive = ", active";
  constexpr std::string_view kEnabled = ", enabled as spindle ";
  const auto dash = line.find(" - ");
  if (dash == std::string_view::npos) return std::nullopt;
  const auto id = base::parse_int(line.substr(0, dash));
  if (!id || *id < 0) return std::nullopt;
  SpindleFact spindle{.id = *id, .source = FactSource::Told};
  std::string_view name = line.substr(dash + 3);
  if (name.ends_with(kActive)) {
    spindle.flags = "*";
    name.remove_suffix(kActive.size());
  }
  if (const auto at = name.rfind(kEnabled); at != std::string_view::npos) {
    spindle.number = base::parse_int(name.substr(at + kEnabled.size()));
    name = name.substr(0, at);
  }
  spindle.name = std::string{name};
  return spindle;
}

}  // namespace kerf::machine
