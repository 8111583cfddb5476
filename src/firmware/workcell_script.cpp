#include "firmware/workcell_script.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "common/base/duration_text.hpp"
#include "common/base/text.hpp"
#include "firmware/ports.hpp"

namespace kerf::firmware {
namespace {

using vocabulary::Axis;

/// The words behind a command's name.
using Words = std::span<const std::string_view>;
/// Nothing: the words are none of this command.
using ParsedDeed = std::optional<Deed>;

/// One way to write a command.
struct CommandRow {
  std::string_view name;
  std::string_view usage;
  ParsedDeed (*parse)(std::string_view name, Words words);
};

bool is_any(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

std::optional<bool> is_on(std::string_view word) {
  if (is_any(word, {"on", "open", "press"})) return true;
  if (is_any(word, {"off", "close", "release"})) return false;
  return std::nullopt;
}

std::optional<Input> input_named(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, Input>, 6> kInputs{{{"probe", Input::Probe},
                                                                              {"door", Input::Door},
                                                                              {"hold", Input::FeedHold},
                                                                              {"start", Input::CycleStart},
                                                                              {"reset", Input::Reset},
                                                                              {"estop", Input::EmergencyStop}}};
  const auto* const row = std::ranges::find(kInputs, word, [](const auto& pair) { return pair.first; });
  if (row == kInputs.end()) return std::nullopt;
  return row->second;
}

std::optional<Axis> axis_named(std::string_view word) {
  return word.size() == 1 ? vocabulary::axis_of(base::to_upper(word.front())) : std::nullopt;
}

std::optional<Directions> directions_named(std::string_view word) {
  if (word == "to") return Directions{.to_controller = true};
  if (word == "from") return Directions{.from_controller = true};
  if (word == "both") return Directions{.to_controller = true, .from_controller = true};
  return std::nullopt;
}

ParsedDeed parse_input(std::string_view name, Words words) {
  if (words.size() != 1) return std::nullopt;
  if (name == "probe" && is_any(words[0], {"plug", "unplug"})) {
    return WorkcellEvent{InputChanged{.input = Input::ProbeDisconnected, .active = words[0] == "unplug"}};
  }
  const auto input = input_named(name);
  const auto active = is_on(words[0]);
  if (!input || !active) return std::nullopt;
  return WorkcellEvent{InputChanged{.input = *input, .active = *active}};
}

ParsedDeed parse_button(std::string_view name, Words words) {
  if (!words.empty()) return parse_input(name, words);
  const auto input = input_named(name);
  return input ? ParsedDeed{PressButton{.input = *input}} : std::nullopt;
}

ParsedDeed parse_limit(std::string_view /*name*/, Words words) {
  if (words.size() != 2) return std::nullopt;
  const auto axis = axis_named(words[0]);
  const auto active = is_on(words[1]);
  if (!axis || !active) return std::nullopt;
  return WorkcellEvent{LimitHeld{.axis = *axis, .active = *active}};
}

ParsedDeed parse_switch(std::string_view /*name*/, Words words) {
  if (words.size() != 2) return std::nullopt;
  const auto axis = axis_named(words[0]);
  const auto distance_mm = base::parse_decimal(words[1]);
  if (!axis || (!distance_mm && words[1] != "none")) return std::nullopt;
  return WorkcellEvent{HomingSwitchMoved{.axis = *axis, .distance_mm = distance_mm}};
}

ParsedDeed parse_lose(std::string_view /*name*/, Words words) {
  if (words.size() != 2) return std::nullopt;
  const auto axis = axis_named(words[0]);
  const auto steps = base::parse_int<std::int32_t>(words[1]);
  if (!axis || !steps) return std::nullopt;
  return WorkcellEvent{StepsLost{.axis = *axis, .steps = *steps}};
}

ParsedDeed parse_surface(std::string_view /*name*/, Words words) {
  if (words.empty()) return std::nullopt;
  ProbeSurfaceMoved moved{.z_mm = base::parse_decimal(words[0])};
  if (!moved.z_mm && (words[0] != "none" || words.size() > 1)) return std::nullopt;
  for (words = words.subspan(1); !words.empty(); words = words.subspan(3)) {
    if (words.size() < 3) return std::nullopt;
    const auto first = base::parse_decimal(words[1]);
    const auto second = base::parse_decimal(words[2]);
    if (!first || !second) return std::nullopt;
    if (words[0] == "tilt") {
      moved.shape.tilt_x = *first;
      moved.shape.tilt_y = *second;
    } else if (words[0] == "wave" && *second > 0) {
      moved.shape.wave_mm = *first;
      moved.shape.wave_length_mm = *second;
    } else {
      return std::nullopt;
    }
  }
  return WorkcellEvent{moved};
}

/// A user input; there are at most as many as a firmware can have.
std::optional<std::uint8_t> port_named(std::string_view word) {
  const auto port = base::parse_int<std::uint8_t>(word);
  return port && *port < Ports::kMost ? port : std::nullopt;
}

ParsedDeed parse_port(std::string_view name, Words words) {
  if (words.size() != 2) return std::nullopt;
  const auto port = port_named(words[0]);
  const bool digital = name == "input";
  const auto active = is_on(words[1]);
  const auto value =
      digital ? (active ? std::optional{*active ? 1.0 : 0.0} : std::nullopt) : base::parse_decimal(words[1]);
  if (!port || !value) return std::nullopt;
  return WorkcellEvent{PortInputChanged{.digital = digital, .port = *port, .value = static_cast<float>(*value)}};
}

ParsedDeed parse_spindle(std::string_view /*name*/, Words words) {
  if (words.size() == 1 && words[0] == "free") return WorkcellEvent{SpindleLoaded{.share = 1}};
  if (words.size() == 1 && words[0] == "stuck") return WorkcellEvent{SpindleLoaded{.share = 0}};
  if (words.size() != 2 || words[0] != "slow") return std::nullopt;
  const auto share = base::parse_decimal(words[1]);
  if (!share || *share < 0 || *share > 2) return std::nullopt;
  return WorkcellEvent{SpindleLoaded{.share = *share}};
}

ParsedDeed parse_encoder(std::string_view /*name*/, Words words) {
  if (words.size() != 1 || !is_any(words[0], {"plug", "unplug"})) return std::nullopt;
  return WorkcellEvent{EncoderPlugged{.plugged = words[0] == "plug"}};
}

ParsedDeed parse_link(std::string_view /*name*/, Words words) {
  if (words.size() != 1) return std::nullopt;
  if (words[0] == "cut") return SetLink{LinkState::Cut};
  if (words[0] == "silent") return SetLink{LinkState::Silent};
  if (words[0] == "restore") return SetLink{LinkState::Up};
  return std::nullopt;
}

/// "next 3", "rate 0.01", "off"
bool read_extent(ByteFaultOrder& order, Words words) {
  if (words.size() == 1 && words[0] == "off") return true;
  if (words.size() != 2) return false;
  if (words[0] == "next") {
    const auto count = base::parse_int<std::size_t>(words[1]);
    order.next_bytes = count.value_or(0);
    return order.next_bytes > 0;
  }
  const auto rate = base::parse_decimal(words[1]);
  order.rate = rate.value_or(-1);
  return words[0] == "rate" && order.rate > 0 && order.rate <= 1;
}

ParsedDeed parse_byte_fault(std::string_view name, Words words) {
  static constexpr std::array<std::pair<std::string_view, ByteFault>, 3> kFaults{
      {{"drop", ByteFault::Drop}, {"duplicate", ByteFault::Duplicate}, {"corrupt", ByteFault::Corrupt}}};
  const auto* const row = std::ranges::find(kFaults, name, [](const auto& pair) { return pair.first; });
  if (words.empty() || row == kFaults.end()) return std::nullopt;
  const auto directions = directions_named(words[0]);
  ByteFaultOrder order{.kind = row->second};
  if (!directions || !read_extent(order, words.subspan(1))) return std::nullopt;
  return OrderByteFault{.directions = *directions, .order = order};
}

ParsedDeed parse_delay(std::string_view /*name*/, Words words) {
  if (words.size() < 2) return std::nullopt;
  const auto directions = directions_named(words[0]);
  ByteFaultOrder order{.kind = ByteFault::Delay};
  const auto time = base::parse_duration(words[1]);
  order.delay = time.value_or(Duration{});
  if (time && words.size() == 2) {
    order.rate = 1;
  } else if (!read_extent(order, words.subspan(time ? 2 : 1)) || (!time && words[1] != "off")) {
    return std::nullopt;
  }
  return directions ? ParsedDeed{OrderByteFault{.directions = *directions, .order = order}} : std::nullopt;
}

ParsedDeed parse_faults(std::string_view /*name*/, Words words) {
  return words.size() == 1 && words[0] == "off" ? ParsedDeed{EndByteFaults{}} : std::nullopt;
}

ParsedDeed parse_seed(std::string_view /*name*/, Words words) {
  const auto seed = words.size() == 1 ? base::parse_int<std::uint64_t>(words[0]) : std::nullopt;
  return seed ? ParsedDeed{SeedChance{*seed}} : std::nullopt;
}

ParsedDeed parse_stall(std::string_view /*name*/, Words words) {
  const auto time = words.size() == 1 ? base::parse_duration(words[0]) : std::nullopt;
  return time ? ParsedDeed{Stall{*time}} : std::nullopt;
}

ParsedDeed parse_reboot(std::string_view /*name*/, Words words) {
  return words.empty() ? ParsedDeed{Reboot{}} : std::nullopt;
}

ParsedDeed parse_power(std::string_view /*name*/, Words words) {
  const auto on = words.size() == 1 ? is_on(words[0]) : std::nullopt;
  return on ? ParsedDeed{SetPower{*on}} : std::nullopt;
}

/// From the first of the words to the end of the last, with the blanks between them.
std::string_view text_of(Words words) {
  if (words.empty()) return {};
  const char* const end = words.back().data() + words.back().size();
  return {words.front().data(), static_cast<std::size_t>(end - words.front().data())};
}

ParsedDeed parse_inject(std::string_view /*name*/, Words words) {
  if (words.size() < 2) return std::nullopt;
  const auto directions = directions_named(words[0]);
  auto bytes = base::unescape(text_of(words.subspan(1)));
  if (!directions || !bytes) return std::nullopt;
  return InjectBytes{.directions = *directions, .bytes = *std::move(bytes)};
}

ParsedDeed parse_pendant(std::string_view /*name*/, Words words) {
  if (words.size() == 1 && is_any(words[0], {"take", "return"})) return PendantTakes{.command = words[0] == "take"};
  if (words.size() < 2 || words[0] != "say") return std::nullopt;
  auto bytes = base::unescape(text_of(words.subspan(1)));
  return bytes ? ParsedDeed{PendantSays{.bytes = *std::move(bytes)}} : std::nullopt;
}

ParsedDeed parse_note(std::string_view /*name*/, Words words) {
  return words.empty() ? std::nullopt : ParsedDeed{WriteNote{std::string(text_of(words))}};
}

constexpr std::array kCommands{
    CommandRow{"door", "door open|close", parse_input},
    CommandRow{"estop", "estop press|release", parse_input},
    CommandRow{"hold", "hold [press|release]", parse_button},
    CommandRow{"start", "start [press|release]", parse_button},
    CommandRow{"reset", "reset [press|release]", parse_button},
    CommandRow{"limit", "limit X|Y|Z|A|B|C|U|V on|off", parse_limit},
    CommandRow{"switch", "switch X|Y|Z|A|B|C|U|V MM|none", parse_switch},
    CommandRow{"lose", "lose X|Y|Z|A|B|C|U|V STEPS", parse_lose},
    CommandRow{"probe", "probe on|off|plug|unplug", parse_input},
    CommandRow{"surface", "surface Z|none [tilt X Y] [wave HEIGHT LENGTH]", parse_surface},
    CommandRow{"input", "input N on|off", parse_port},
    CommandRow{"analog", "analog N VALUE", parse_port},
    CommandRow{"spindle", "spindle free|stuck | slow SHARE", parse_spindle},
    CommandRow{"encoder", "encoder plug|unplug", parse_encoder},
    CommandRow{"pendant", "pendant take|return | say TEXT with \\n, \\x8b …", parse_pendant},
    CommandRow{"link", "link cut|silent|restore", parse_link},
    CommandRow{"drop", "drop to|from|both next N | rate R | off", parse_byte_fault},
    CommandRow{"duplicate", "duplicate to|from|both next N | rate R | off", parse_byte_fault},
    CommandRow{"corrupt", "corrupt to|from|both next N | rate R | off", parse_byte_fault},
    CommandRow{"delay", "delay to|from|both TIME [next N | rate R] | off", parse_delay},
    CommandRow{"faults", "faults off", parse_faults},
    CommandRow{"seed", "seed N", parse_seed},
    CommandRow{"inject", "inject to|from|both TEXT with \\n, \\x18 …", parse_inject},
    CommandRow{"stall", "stall TIME", parse_stall},
    CommandRow{"reboot", "reboot", parse_reboot},
    CommandRow{"power", "power off|on", parse_power},
    CommandRow{"note", "note TEXT", parse_note},
};

constexpr std::string_view kTimings = "at TIME, after TIME, when state NAME or when line N";
constexpr std::string_view kTimes = "a TIME such as 200ms, 1.5s or 2min";

std::string quoted(std::string_view word) {
  return "'" + std::string(word) + "'";
}

using ParsedTiming = std::expected<Timing, ScriptError>;

std::unexpected<ScriptError> wrong(std::string what, std::string_view accepted) {
  return std::unexpected(ScriptError{.line = 0, .what = std::move(what), .accepted = std::string(accepted)});
}

std::string state_names() {
  std::string names;
  for (const auto& row : vocabulary::machine_state_rows()) {
    names += names.empty() ? "" : ", ";
    names += row.name;
  }
  return names + "; Hold:0 also asks for the number behind the colon";
}

ParsedTiming parse_state(std::string_view word) {
  const auto parts = base::split_at_most(word, ':', 2);
  const auto state = vocabulary::machine_state_of(parts[0]);
  WhenState when{.state = state.value_or(vocabulary::MachineState::Unknown), .substate = std::nullopt};
  if (parts.size() == 2) when.substate = base::parse_int(parts[1]);
  if (!state || (parts.size() == 2 && !when.substate)) return wrong(quoted(word) + " is no state", state_names());
  return when;
}

/// Reads the timing at the front of `words` and takes it away.
ParsedTiming take_timing(Words& words) {
  const std::string_view first = words.front();
  if (!is_any(first, {"at", "after", "when"})) return AfterTime{};
  const std::size_t length = first == "when" ? 3 : 2;
  if (words.size() < length) return wrong(quoted(text_of(words)) + " is no timing", kTimings);
  const std::string_view value = words[length - 1];
  const std::string_view kind = words[1];
  words = words.subspan(length);
  if (first == "when") {
    if (kind == "state") return parse_state(value);
    const auto lines = base::parse_int<std::uint32_t>(value);
    if (kind == "line" && lines) return WhenLine{*lines};
    return wrong(quoted("when " + std::string(kind) + " " + std::string(value)) + " is no timing", kTimings);
  }
  const auto time = base::parse_duration(value);
  if (!time) return wrong(quoted(value) + " is no time", kTimes);
  if (first == "at") return AtTime{*time};
  return AfterTime{*time};
}

std::expected<Deed, ScriptError> parse_deed(Words words) {
  const std::string_view name = words.front();
  const auto* const row = std::ranges::find(kCommands, name, &CommandRow::name);
  if (row == kCommands.end()) {
    std::string names{kTimings};
    for (const CommandRow& command : kCommands) names += ", " + std::string(command.name);
    return wrong(quoted(name) + " is no command", names);
  }
  auto deed = row->parse(name, words.subspan(1));
  if (!deed) return wrong(quoted(text_of(words)) + " is incomplete or wrong", row->usage);
  return *std::move(deed);
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (!(text = base::trim(text)).empty()) {
    const auto end = std::ranges::find_if(text, base::is_blank);
    words.push_back(text.substr(0, static_cast<std::size_t>(end - text.begin())));
    text.remove_prefix(words.back().size());
  }
  return words;
}

}  // namespace

std::expected<std::optional<ScriptLine>, ScriptError> parse_script_line(std::string_view text, std::size_t number) {
  // A `#` inside a word is text: `inject to G1#2`.
  std::size_t comment = text.starts_with('#') ? 0 : text.find(" #");
  const std::string_view content = base::trim(text.substr(0, comment));
  if (content.empty()) return std::nullopt;
  const auto words = words_of(content);
  Words rest(words);
  ScriptLine line{.number = number, .text = std::string(content), .timing = {}, .deed = std::nullopt};
  const auto on_this_line = [&](ScriptError error) {
    error.line = number;
    return std::unexpected(std::move(error));
  };
  auto timing = take_timing(rest);
  if (!timing) return on_this_line(std::move(timing).error());
  line.timing = *timing;
  if (rest.empty()) return line;
  auto deed = parse_deed(rest);
  if (!deed) return on_this_line(std::move(deed).error());
  line.deed = *std::move(deed);
  return line;
}

std::expected<std::vector<ScriptLine>, ScriptError> parse_script(std::string_view text) {
  std::vector<ScriptLine> script;
  std::size_t number = 0;
  for (const std::string_view row : base::split(text, '\n')) {
    auto line = parse_script_line(row, ++number);
    if (!line) return std::unexpected(std::move(line).error());
    if (*line) script.push_back(**std::move(line));
  }
  return script;
}

std::optional<WorkcellEvent> parse_workcell_event(std::string_view text) {
  const auto words = words_of(text);
  if (words.empty()) return std::nullopt;
  const auto deed = parse_deed(words);
  if (!deed) return std::nullopt;
  const auto* const event = std::get_if<WorkcellEvent>(&*deed);
  return event != nullptr ? std::optional{*event} : std::nullopt;
}

std::string explain(const ScriptError& error) {
  return error.what + "; accepted: " + error.accepted;
}

std::vector<std::string_view> script_usage() {
  std::vector<std::string_view> usages;
  for (const CommandRow& command : kCommands) usages.push_back(command.usage);
  return usages;
}

}  // namespace kerf::firmware
