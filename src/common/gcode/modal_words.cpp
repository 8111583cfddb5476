#include "common/gcode/modal_words.hpp"

#include <cstdint>

#include "common/gcode/numbers.hpp"
#include "common/gcode/print_number.hpp"

namespace kerf::gcode {

namespace {

constexpr std::string_view kMotionWords[] = {"G0",  "G1",   "G2",  "G3",    "G38.2", "G38.3", "G38.4", "G38.5",
                                             "G73", "G81",  "G82", "G83",   "G85",   "G86",   "G89",   "G84",
                                             "G5",  "G5.1", "G33", "G33.1", "G76",   "G80"};
/// Rabbit counts the probe modes from one less.
constexpr std::string_view kRabbitProbeWords[] = {"G38.1", "G38.2", "G38.3", "G38.4"};
constexpr std::string_view kWorkOffsetWords[] = {"G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"};
constexpr float kInchPerMm = 0.0393701F;

class Words {
 public:
  explicit Words(std::string& out) : out_(out) {}

  void add(std::string_view word) {
    if (!first_) out_ += ' ';
    first_ = false;
    out_ += word;
  }

  std::string& text() { return out_; }

 private:
  std::string& out_;
  bool first_ = true;
};

std::string_view motion_word(const ParserState& state, bool rabbit) {
  const auto at = static_cast<std::size_t>(state.modal.motion);
  constexpr auto kFirstProbe = static_cast<std::size_t>(MotionMode::ProbeToward);
  if (rabbit && at >= kFirstProbe && at < kFirstProbe + std::size(kRabbitProbeWords))
    return kRabbitProbeWords[at - kFirstProbe];
  return kMotionWords[at];
}

std::string_view plane_word(Plane plane) {
  switch (plane) {
    case Plane::XY: return "G17";
    case Plane::ZX: return "G18";
    case Plane::YZ: break;
  }
  return "G19";
}

std::string_view feed_word(FeedMode mode) {
  switch (mode) {
    case FeedMode::UnitsPerMinute: return "G94";
    case FeedMode::InverseTime: return "G93";
    case FeedMode::UnitsPerRevolution: break;
  }
  return "G95";
}

std::string_view tool_length_word(ToolLengthMode mode) {
  switch (mode) {
    case ToolLengthMode::None: return "G49";
    case ToolLengthMode::FromTable: return "G43";
    case ToolLengthMode::Dynamic: return "G43.1";
    case ToolLengthMode::Additional: break;
  }
  return "G43.2";
}

std::string_view spindle_word(SpindleDirection direction) {
  switch (direction) {
    case SpindleDirection::Off: return "M5";
    case SpindleDirection::Clockwise: return "M3";
    case SpindleDirection::Counterclockwise: break;
  }
  return "M4";
}

void add_coolant(const Coolant& coolant, Words& words) {
  if (coolant.mist) words.add("M7");
  if (coolant.flood) words.add("M8");
  if (!coolant.mist && !coolant.flood) words.add("M9");
}

bool has_g92(const Offsets& offsets, int axes) {
  for (int axis = 0; axis < axes; ++axis)
    if (offsets.g92[static_cast<std::size_t>(axis)] != 0.0F) return true;
  return false;
}

void add_scaling(const ParserState& state, int axes, Words& words) {
  if (!state.modal.scaling) return words.add("G50");
  words.add("G51:");
  for (int axis = 0; axis < axes; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    if (state.scale_factor[at] != 1.0F) words.text() += vocabulary::kAxisLetters[at];
  }
}

void add_overrides(const OverridePermissions& permissions, bool shows_parking, Words& words) {
  if (!permissions.feed) words.add("M50");
  if (!permissions.spindle) words.add("M51");
  if (!permissions.feed_hold) words.add("M53");
  if (shows_parking && !permissions.parking) words.add("M56");
}

/// grblHAL cuts F to a whole number, in inches too; Rabbit forgets to convert it; Grbl rounds it.
void add_feed(const ParserState& state, const GcodeRules& rules, bool inches, Words& words) {
  words.add("F");
  const bool converts = inches && rules.report != ReportedGroups::Rabbit;
  const float rate = converts ? state.feed_rate * kInchPerMm : state.feed_rate;
  if (rules.report == ReportedGroups::All) {
    words.text() += std::to_string(to_uint32(static_cast<double>(rate)));
  } else {
    append_number(rules.printer, rate, inches ? 1 : 0, words.text());
  }
}

void add_speed(const ParserState& state, const GcodeRules& rules, Words& words) {
  words.add("S");
  if (rules.report == ReportedGroups::Rabbit) {
    words.text() += std::to_string(to_uint32(static_cast<double>(state.spindle_rpm)));
  } else {
    append_number(rules.printer, state.spindle_rpm, 0, words.text());
  }
}

}  // namespace

void append_modal_words(const ParserState& state, const Offsets& offsets, const GcodeRules& rules,
                        const ModalWordsStyle& style, std::string& out) {
  const ModalState& modal = state.modal;
  const bool all_groups = rules.report == ReportedGroups::All;
  const bool rabbit = rules.report == ReportedGroups::Rabbit;
  Words words(out);

  words.add(motion_word(state, rabbit));
  words.add(kWorkOffsetWords[modal.work_offset]);
  if (all_groups && has_g92(offsets, style.axes)) words.add("G92");
  if (style.lathe) words.add(modal.diameter ? "G7" : "G8");
  words.add(plane_word(modal.plane));
  words.add(modal.inches ? "G20" : "G21");
  if (state.modal_macro) words.add("G66");
  words.add(modal.incremental ? "G91" : "G90");
  words.add(feed_word(modal.feed_mode));
  if (style.lathe) words.add(modal.surface_speed ? "G96" : "G97");
  if (all_groups) {
    words.add("G40");
    words.add(tool_length_word(modal.tool_length));
    words.add(modal.retract == RetractMode::RPosition ? "G99" : "G98");
    add_scaling(state, style.axes, words);
  }
  words.add(spindle_word(modal.spindle));
  if (state.tool_change_pending) words.add("M6");
  add_coolant(modal.coolant, words);
  add_overrides(modal.overrides, style.parking_override_control, words);

  words.add("T");
  out += std::to_string(state.tool);
  add_feed(state, rules, style.inches, words);
  add_speed(state, rules, words);
}

}  // namespace kerf::gcode
