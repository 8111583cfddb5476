#include "sender/machine/capability_collector.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"

namespace kerf::machine {
namespace {

using vocabulary::Firmware;

std::string_view name_of_token(std::string_view token) {
  return token.substr(0, token.find('='));
}

/// `[OPT:V,15,128]` has them; Rabbit prints letters only (protocol.md 4.5).
bool has_sizes(const protocol::BuildOptions& options) {
  return options.planner_blocks || options.rx_bytes;
}

}  // namespace

bool Capabilities::has(std::string_view token) const {
  return std::ranges::any_of(capabilities, [token](const auto& known) { return name_of_token(known) == token; });
}

void CapabilityCollector::fold(const protocol::Message& message) {
  std::visit(base::Overloaded{
                 [&](const protocol::Welcome& welcome) { welcome_ = welcome; },
                 [&](const protocol::Version& version) { version_ = version; },
                 [&](const protocol::BuildOptions& options) { options_ = options; },
                 [&](const protocol::AxisNames& names) { axis_names_ = names; },
                 [&](const protocol::NewOptions& options) { new_options_ = options; },
                 [&](const protocol::FirmwareName& name) { firmware_name_ = name.name; },
                 [&](const protocol::StatusReport& report) {
                   if (report.firmware) firmware_name_ = *report.firmware;
                   const auto& position = report.machine_position ? report.machine_position : report.work_position;
                   if (position) axes_seen_ = static_cast<int>(position->size());
                 },
                 [&](const protocol::BuildRow& row) {
                   std::erase_if(build_rows_, [&](const BuildFact& known) { return known.key == row.key; });
                   build_rows_.push_back({.key = row.key, .value = row.value});
                 },
                 [&](const protocol::SettingValue& value) {
                   const auto known = std::ranges::find(values_, value.id, &protocol::SettingValue::id);
                   if (known == values_.end())
                     values_.push_back(value);
                   else
                     known->value = value.value;
                 },
                 [&](const protocol::SettingGroupRow& group) { groups_[group.id] = group.name; },
                 [&](const protocol::SettingDefinition& definition) { definitions_[definition.id] = definition; },
                 [&](const protocol::AlarmCodeRow& row) { lexicon_.learn(row); },
                 [&](const protocol::ErrorCodeRow& row) { lexicon_.learn(row); },
                 [](const auto&) {},
             },
             message);
}

void CapabilityCollector::forget() {
  *this = {};
}

Firmware CapabilityCollector::family() const {
  if (base::iequals(firmware_name_, "grblHAL") || new_options_) return Firmware::GrblHal;
  if (!firmware_name_.empty()) return Firmware::Unknown;
  if (welcome_ && welcome_->firmware == Firmware::Rabbit) return Firmware::Rabbit;
  if (welcome_ && welcome_->firmware == Firmware::GrblHal) return Firmware::GrblHal;
  if (version_ && options_) {
    const bool like_rabbit = !version_->has_user_text && !has_sizes(*options_);
    const bool like_grbl = version_->has_user_text && has_sizes(*options_);
    if (like_rabbit) return Firmware::Rabbit;
    if (like_grbl) return Firmware::Grbl;
  }
  return welcome_ ? welcome_->firmware : Firmware::Unknown;
}

FactSource CapabilityCollector::family_source() const {
  if (!firmware_name_.empty()) return FactSource::Told;
  if (welcome_ && welcome_->firmware == family()) return FactSource::Told;
  return family() == Firmware::Unknown ? FactSource::Assumed : FactSource::Inferred;
}

bool CapabilityCollector::has_token(std::string_view token) const {
  if (!new_options_) return false;
  return std::ranges::any_of(new_options_->flags, [token](const auto& flag) { return name_of_token(flag) == token; });
}

AxesFact CapabilityCollector::axes() const {
  const auto letters_of = [](int count) {
    const auto most = std::min<std::size_t>(static_cast<std::size_t>(std::max(count, 0)), vocabulary::kMaxAxes);
    return std::string{vocabulary::kAxisLetters.substr(0, most)};
  };
  if (axis_names_) {
    return {.count = axis_names_->count, .letters = axis_names_->letters, .source = FactSource::Told};
  }
  if (options_ && options_->axes) {
    return {.count = *options_->axes, .letters = letters_of(*options_->axes), .source = FactSource::Told};
  }
  if (axes_seen_ > 0) {
    return {.count = axes_seen_, .letters = letters_of(axes_seen_), .source = FactSource::Inferred};
  }
  const int count = dialect().axes_default;
  return {.count = count, .letters = letters_of(count), .source = FactSource::Assumed};
}

BuffersFact CapabilityCollector::buffers() const {
  const auto& known = dialect();
  const FactSource assumed = known.firmware == Firmware::Unknown ? FactSource::Assumed : FactSource::Inferred;
  BuffersFact buffers{.rx_bytes = known.rx_bytes.usable,
                      .rx_usable = known.rx_bytes.usable,
                      .rx_source = assumed,
                      .planner_blocks = known.planner_blocks.usable,
                      .planner_source = assumed,
                      .line_length = known.line_length,
                      .line_source = assumed};
  if (options_ && options_->rx_bytes && *options_->rx_bytes > 1) {
    buffers.rx_bytes = *options_->rx_bytes;
    // A ring buffer of n bytes holds n - 1; grblHAL prints the ring, Grbl what it holds (protocol.md 6.1).
    buffers.rx_usable = *options_->rx_bytes - 1;
    buffers.rx_source = FactSource::Told;
  }
  if (options_ && options_->planner_blocks) {
    buffers.planner_blocks = *options_->planner_blocks;
    buffers.planner_source = FactSource::Told;
  }
  return buffers;
}

std::vector<std::string> CapabilityCollector::tokens() const {
  if (new_options_) return new_options_->flags;
  std::vector<std::string> tokens;
  if (dialect().can_enumerate_codes) tokens.emplace_back("CODES");
  const auto homing = std::ranges::find(values_, "22", &protocol::SettingValue::id);
  if (homing != values_.end() && base::parse_int(homing->value).value_or(0) % 2 == 1) tokens.emplace_back("HOME");
  return tokens;
}

SettingFact CapabilityCollector::describe_setting(const std::string& id) const {
  SettingFact fact{.id = id};
  const auto number = base::parse_int(id);
  if (number) {
    if (const auto told = definitions_.find(*number); told != definitions_.end()) {
      const auto& row = told->second;
      const auto group = groups_.find(row.group);
      return {.id = id,
              .value = std::nullopt,
              .name = row.name,
              .unit = row.unit,
              .group = group == groups_.end() ? "" : group->second,
              .type = row.type,
              .format = row.format,
              .min = row.min,
              .max = row.max,
              .reboot_required = row.reboot,
              .allow_null = row.allow_null,
              .source = FactSource::Told};
    }
  }
  const auto match = vocabulary::find_setting(dialect().settings, std::string_view{id}, axes().count);
  if (!match) return fact;
  const auto& row = *match->row;
  fact.name = vocabulary::full_name(*match);
  fact.unit = row.unit;
  fact.type = static_cast<int>(row.type);
  fact.format = row.format;
  fact.min = row.min.text();
  fact.max = row.max.text();
  fact.reboot_required = row.reboot;
  fact.allow_null = row.allow_null;
  fact.source = FactSource::Inferred;
  const int group_id = vocabulary::group_of(*match);
  const auto groups = vocabulary::setting_group_rows();
  const auto group = std::ranges::find(groups, group_id, &vocabulary::SettingGroupRow::id);
  if (group != groups.end()) fact.group = group->name;
  return fact;
}

std::vector<SettingFact> CapabilityCollector::settings() const {
  std::vector<SettingFact> facts;
  for (const auto& value : values_) {
    facts.push_back(describe_setting(value.id));
    facts.back().value = value.value;
  }
  for (const auto& [id, definition] : definitions_) {
    const std::string key = std::to_string(id);
    if (std::ranges::find(values_, key, &protocol::SettingValue::id) == values_.end()) {
      facts.push_back(describe_setting(key));
    }
  }
  return facts;
}

Capabilities CapabilityCollector::capabilities(bool complete) const {
  Capabilities result;
  const auto& known = dialect();
  result.family = known.firmware;
  result.firmware = known.firmware == Firmware::Unknown && !firmware_name_.empty()
                        ? firmware_name_
                        : std::string{vocabulary::name_of(known.firmware)};
  result.firmware_source = family_source();
  if (welcome_) result.welcome = welcome_->line;
  // Rabbit's `[VER:1.1h.20260315]` names the protocol it follows; its own version stands in the welcome only.
  if (version_) {
    result.version = version_->version;
    result.build = version_->build;
    result.user_text = version_->user_text;
  }
  if (welcome_ && !welcome_->version.empty() && (!version_ || known.firmware == Firmware::Rabbit)) {
    result.version = welcome_->version;
  }
  if (options_) {
    result.options = options_->letters;
    result.tools = options_->tools;
  }
  result.capabilities = tokens();
  result.axes = axes();
  result.buffers = buffers();
  result.build_rows = build_rows_;
  result.complete = complete;
  result.alarms = lexicon_.alarms(known);
  result.errors = lexicon_.errors(known);
  result.settings = settings();
  return result;
}

std::string summary_of(const Capabilities& capabilities) {
  std::string text = capabilities.firmware;
  if (!capabilities.version.empty()) text += " " + capabilities.version;
  if (!capabilities.build.empty()) text += " (build " + capabilities.build + ")";
  text += ", axes " + capabilities.axes.letters;
  text += ", " + std::to_string(capabilities.buffers.rx_bytes) + " bytes of receive buffer";
  text += ", " + std::to_string(capabilities.buffers.planner_blocks) + " planner blocks";
  return text;
}

}  // namespace kerf::machine
