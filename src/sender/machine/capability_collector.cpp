#include "sender/machine/capability_collector.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

#include <boost/describe.hpp>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "sender/machine/startup_line.hpp"

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

/// Rows of `$I+` that tell of the hardware and of what is compiled in.
constexpr std::array<std::string_view, 7> kLastingRows{"BOARD",  "DRIVER", "DRIVER VERSION", "DRIVER OPTIONS",
                                                       "AUX IO", "PLUGIN", "SIGNALS"};

// Columns of `$ESH` behind the id.
constexpr std::size_t kTableColumns = 9;
constexpr std::size_t kHelpColumn = 4;

/// grblHAL writes line breaks as the two characters `\n` (protocol.md 5.1).
std::string with_line_feeds(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.substr(at, 2) == "\\n") {
      out += '\n';
      ++at;
    } else {
      out += text[at];
    }
  }
  return out;
}

bool is_coordinate_system(std::string_view name) {
  return name.size() >= 3 && name.starts_with("G5");
}

std::string_view type_name(int type) {
  const auto known = static_cast<vocabulary::SettingType>(type);
  return boost::describe::enum_to_string(known, "");
}

}  // namespace

const SettingFact* Capabilities::find_setting(std::string_view id) const {
  const auto find = [this](std::string_view key) {
    auto found = std::ranges::find(settings, key, &SettingFact::id);
    const auto alike = [key](const SettingFact& setting) { return base::iequals(setting.id, key); };
    if (found == settings.end()) found = std::ranges::find_if(settings, alike);
    return found == settings.end() ? nullptr : &*found;
  };
  if (const SettingFact* setting = find(id)) return setting;
  const auto match = vocabulary::find_setting(vocabulary::dialect_of(family).settings, id);
  if (!match || match->row->id < 0) return nullptr;
  return find(std::to_string(match->row->id + match->axis));
}

bool Capabilities::has(std::string_view token) const {
  return std::ranges::any_of(capabilities, [token](const auto& known) { return name_of_token(known) == token; });
}

void CapabilityCollector::fold(const protocol::Message& message) {
  std::visit(base::Overloaded{
                 [&](const protocol::Welcome& welcome) { welcome_ = welcome; },
                 [&](const protocol::Version& version) {
                   version_ = version;
                   build_rows_.clear();  // the first row of `$I`: the others follow
                 },
                 [&](const protocol::BuildOptions& options) { options_ = options; },
                 [&](const protocol::AxisNames& names) { axis_names_ = names; },
                 [&](const protocol::NewOptions& options) { new_options_ = options; },
                 [&](const protocol::FirmwareName& name) { firmware_name_ = name.name; },
                 [&](const protocol::StatusReport& report) {
                   if (report.firmware) firmware_name_ = *report.firmware;
                   const auto& position = report.machine_position ? report.machine_position : report.work_position;
                   if (position) axes_seen_ = static_cast<int>(position->size());
                 },
                 [&](const protocol::BuildRow& row) { fold_build_row(row); },
                 [&](const protocol::SettingValue& value) { fold_value(value); },
                 [&](const protocol::StartupLine& line) {
                   fold_value({.id = "N" + std::to_string(line.index), .value = line.block});
                 },
                 [&](const protocol::StoredOffset& offset) { fold_offset(offset.name); },
                 [&](const protocol::SettingTableRow& row) { fold_table_row(row); },
                 [&](const protocol::SettingDescription& row) { helps_[row.id] = with_line_feeds(row.text); },
                 [&](const protocol::Unrecognized& other) { fold_other(other.line); },
                 [&](const protocol::Ok&) { open_row_.reset(); },
                 [&](const protocol::SettingGroupRow& group) { groups_[group.id] = group; },
                 [&](const protocol::SettingDefinition& definition) { definitions_[definition.id] = definition; },
                 [&](const protocol::AlarmCodeRow& row) { lexicon_.learn(row); },
                 [&](const protocol::ErrorCodeRow& row) { lexicon_.learn(row); },
                 [](const auto&) {},
             },
             message);
}

std::string CapabilityCollector::id_of(std::string_view id) const {
  const auto match = vocabulary::find_setting(dialect().settings, id);
  if (!match || match->row->id < 0) return std::string{id};
  return std::to_string(match->row->id + match->axis);
}

void CapabilityCollector::fold_value(const protocol::SettingValue& value) {
  // A startup line of Rabbit in the list of all names: no setting.
  if (value.id.starts_with("GCode/Line")) return;
  const std::string id = id_of(value.id);
  const auto known = std::ranges::find(values_, id, &protocol::SettingValue::id);
  if (known == values_.end()) {
    values_.push_back({.id = id, .value = value.value});
  } else if (id == value.id) {
    // Under its name a setting may be printed another way ("XY" for 3): the number's form is kept.
    known->value = value.value;
  }
}

void CapabilityCollector::fold_build_row(const protocol::BuildRow& row) {
  if (row.key == "SPINDLE") {
    const auto spindle = read_spindle_row(row.value);
    if (!spindle) return;
    std::erase_if(spindles_, [&](const SpindleFact& known) { return known.id == spindle->id; });
    spindles_.push_back(*spindle);
    return;
  }
  // Several rows may have one key: `[PLUGIN:…]`.
  const BuildFact fact{.key = row.key, .value = row.value};
  if (std::ranges::find(build_rows_, fact) == build_rows_.end()) build_rows_.push_back(fact);
}

void CapabilityCollector::fold_table_row(const protocol::SettingTableRow& row) {
  open_row_.reset();
  if (row.columns.size() <= kHelpColumn) {
    open_row_ = row;
    return;
  }
  helps_[row.id] = with_line_feeds(row.columns[kHelpColumn]);
  if (row.columns.size() < kTableColumns) open_row_ = row;
}

void CapabilityCollector::fold_other(const std::string& line) {
  if (const auto spindle = read_spindle_line(line); spindle && !knows_spindles()) spindles_.push_back(*spindle);
  if (!open_row_ || open_row_->columns.empty()) return;
  auto rest = base::split(line, '\t');
  protocol::SettingTableRow row = *std::move(open_row_);
  row.columns.back() += '\n';
  row.columns.back() += rest.front();
  for (std::size_t index = 1; index < rest.size(); ++index) row.columns.emplace_back(rest[index]);
  fold_table_row(row);
}

void CapabilityCollector::fold_offset(const std::string& name) {
  if (!is_coordinate_system(name)) return;
  if (std::ranges::find(coordinate_systems_, name) == coordinate_systems_.end()) coordinate_systems_.push_back(name);
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

std::string CapabilityCollector::identity() const {
  if (!version_ || !options_) return {};
  std::string text{dialect().key};
  const auto add = [&text](std::string_view part) { (text += '|') += part; };
  add(version_->version);
  add(version_->build);
  add(options_->letters);
  add(axes().letters);
  for (const auto& flag : new_options_.value_or(protocol::NewOptions{}).flags) add(flag);
  for (const BuildFact& row : build_rows_) {
    // Not those that change from day to day, such as free memory or an address.
    if (std::ranges::find(kLastingRows, row.key) != kLastingRows.end()) add(row.key + ":" + row.value);
  }
  return text;
}

bool CapabilityCollector::has_undescribed_value() const {
  return !definitions_.empty() && std::ranges::any_of(values_, [this](const protocol::SettingValue& value) {
    const auto number = base::parse_int(value.id);
    return number && !definitions_.contains(*number);
  });
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

SettingFact CapabilityCollector::describe_from_table(const std::string& id) const {
  SettingFact fact{.id = id};
  const auto match = vocabulary::find_setting(dialect().settings, std::string_view{id}, axes().count);
  if (!match) return fact;
  const auto& row = *match->row;
  fact.name = vocabulary::full_name(*match);
  fact.unit = row.unit;
  fact.type = static_cast<int>(row.type);
  fact.format = vocabulary::format_of(row, axes().count);
  fact.min = row.min.text();
  fact.max = row.max.text();
  fact.reboot_required = row.reboot;
  fact.allow_null = row.allow_null;
  fact.help = with_line_feeds(row.description);
  fact.group_id = vocabulary::group_of(*match);
  fact.source = fact.help_source = FactSource::Inferred;
  return fact;
}

SettingFact CapabilityCollector::describe_setting(const std::string& id) const {
  SettingFact fact = describe_from_table(id);
  if (is_startup_line(id)) {
    fact.name = "Startup line " + id.substr(1);
    fact.type = static_cast<int>(vocabulary::SettingType::Text);
    fact.allow_null = true;
    fact.help = "Runs after power-up, a reset and homing; its blocks are G-code.";
    fact.source = fact.help_source = FactSource::Inferred;
  }
  const int number = base::parse_int(id).value_or(-1);
  if (const auto told = definitions_.find(number); told != definitions_.end()) {
    const auto& row = told->second;
    fact.name = row.name;
    fact.unit = row.unit;
    fact.group_id = row.group;
    fact.type = row.type;
    fact.format = row.format;
    fact.min = row.min;
    fact.max = row.max;
    fact.reboot_required = row.reboot;
    fact.allow_null = row.allow_null;
    fact.source = FactSource::Told;
  }
  if (const auto help = helps_.find(number); help != helps_.end()) {
    fact.help = help->second;
    fact.help_source = FactSource::Told;
  }
  fact.type_name = type_name(fact.type);
  const auto known_groups = groups();
  const auto group = std::ranges::find(known_groups, fact.group_id, &SettingGroupFact::id);
  if (group != known_groups.end()) fact.group = group->name;
  return fact;
}

std::vector<SettingGroupFact> CapabilityCollector::groups() const {
  std::vector<SettingGroupFact> facts;
  for (const auto& [id, row] : groups_) facts.push_back({id, row.parent, row.name, FactSource::Told});
  if (!facts.empty() || dialect().settings.empty()) return facts;
  for (const auto& row : vocabulary::setting_group_rows()) {
    facts.push_back({row.id, row.parent, std::string{row.name}, FactSource::Inferred});
  }
  return facts;
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
  result.lists_tokens = new_options_.has_value();
  result.axes = axes();
  result.buffers = buffers();
  result.build_rows = build_rows_;
  result.complete = complete;
  result.alarms = lexicon_.alarms(known);
  result.errors = lexicon_.errors(known);
  result.settings = settings();
  result.setting_groups = groups();
  result.spindles = spindles_;
  result.option_meanings = explain_options(result);
  result.features = features_of(result, coordinate_systems_);
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
