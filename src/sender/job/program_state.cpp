#include "sender/job/program_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"

namespace kerf::job {
namespace {

using vocabulary::AxisValues;

constexpr std::size_t kZ = 2;
/// Far enough from any place for two beliefs to be told apart.
constexpr float kElsewhereMm = 17.0F;

/// `$` lines that change nothing of what a program needs.
bool is_harmless(std::string_view line) {
  constexpr std::array<std::string_view, 8> kAsking{"$$", "$#", "$G", "$I", "$X", "$+", "$N", "$E"};
  if (line.contains('=')) return line.starts_with("$N") || line.starts_with("$I");
  return line == "$" || std::ranges::any_of(kAsking, [line](std::string_view start) {
           return base::starts_with_ignoring_case(line, start);
         });
}

float distance(const AxisValues& from, const AxisValues& to) {
  float sum = 0;
  for (std::size_t axis = 0; axis < from.size(); ++axis) {
    sum += (to.at(axis) - from.at(axis)) * (to.at(axis) - from.at(axis));
  }
  return std::sqrt(sum);
}

/// The highest place of an arc: its ends, or its circle where the plane stands upright.
float top_of(const gcode::ArcMove& arc, const AxisValues& from) {
  const float ends = std::max(from[kZ], arc.target_mm[kZ]);
  const auto axes = gcode::axes_of(arc.plane);
  if (axes.linear == kZ) return ends;
  const float center = from[kZ] + (axes.first == kZ ? arc.center_offset_mm[0] : arc.center_offset_mm[1]);
  return std::max(ends, center + std::abs(arc.radius_mm));
}

/// M6 goes where the firmware has none: there Kerf itself waits for the operator.
std::string without_tool_change(std::string_view line) {
  std::string kept;
  for (const LineWord& word : words_of(line)) {
    const bool is_change = word.letter == 'M' && base::parse_decimal(word.digits) == 6.0;
    if (!is_change) (kept += word.letter) += word.digits;
  }
  return kept;
}

bool same_state(const gcode::Interpreter& one, const gcode::Interpreter& other) {
  const gcode::Offsets& a = one.offsets();
  const gcode::Offsets& b = other.offsets();
  return one.state() == other.state() && a.work == b.work && a.g28 == b.g28 && a.g30 == b.g30 && a.g92 == b.g92 &&
         a.tool_length == b.tool_length;
}

}  // namespace

ProgramState::ProgramState(gcode::Interpreter reader, const vocabulary::Dialect& dialect)
    : reader_(std::move(reader)), dialect_(&dialect) {
  history_.highest_mm = reader_.state().position_mm[kZ];
}

void ProgramState::doubt(std::uint32_t number, std::string because) {
  is_lost_ = true;
  if (!doubt_) doubt_ = StateDoubt{.line = number, .because = std::move(because)};
}

void ProgramState::open_alternative(std::uint32_t number, const AxisValues& position_mm, std::string because) {
  if (!alternative_) alternative_ = reader_;
  alternative_->sync_position(position_mm);
  if (!doubt_) doubt_ = StateDoubt{.line = number, .because = std::move(because)};
}

void ProgramState::compare_alternative() {
  if (!alternative_ || !same_state(reader_, *alternative_)) return;
  alternative_.reset();
  if (!is_lost_) doubt_.reset();
}

void ProgramState::execute(std::uint32_t number, std::string_view line) {
  actions_.clear();
  was_waiting_ = false;
  moved_mm_ = 0;
  if (line.empty()) return;
  if (line.starts_with('$')) return execute_system(number, line);
  const std::vector<LineWord> words = words_of(line);
  if (needs_a_computer(line, words)) {
    doubt(number, "uses parameters, expressions, subroutines or macros, whose values are in the controller only");
  }
  std::string stripped;
  if (dialect_->tool_change == vocabulary::ToolChangeRule::Refused) {
    const bool changes = std::ranges::any_of(
        words, [](const LineWord& word) { return word.letter == 'M' && base::parse_decimal(word.digits) == 6.0; });
    if (changes) {
      stripped = without_tool_change(line);
      line = stripped;
      was_waiting_ = true;
      history_.tool_line = number;
    }
  }
  const AxisValues from = reader_.state().position_mm;
  if (const auto read = reader_.interpret(line, actions_); !read) {
    doubt(number, "is one that this controller refuses (error:" + std::to_string(static_cast<int>(read.error())) +
                      "), so what became of it is not known");
    return;
  }
  if (alternative_) {
    other_actions_.clear();
    if (!alternative_->interpret(line, other_actions_)) alternative_->sync_position(from);
    if (alternative_->state().tool_change_pending) alternative_->complete_tool_change();
  }
  note_words(number, words);
  note_actions(number, from);
  settle_actions(number);
  compare_alternative();
}

void ProgramState::execute_system(std::uint32_t number, std::string_view line) {
  constexpr std::string_view kJog = "$J=";
  if (base::starts_with_ignoring_case(line, kJog)) {
    const auto jog = reader_.interpret_jog(line.substr(kJog.size()));
    if (!jog) return;
    history_.highest_mm = std::max(history_.highest_mm, jog->target_mm[kZ]);
    history_.has_moved = true;
    reader_.sync_position(jog->target_mm);
    if (alternative_) alternative_->sync_position(jog->target_mm);
    return;
  }
  if (base::starts_with_ignoring_case(line, "$H")) {
    was_waiting_ = true;
    history_.has_moved = true;
    AxisValues elsewhere = reader_.state().position_mm;
    for (float& value : elsewhere) value += kElsewhereMm;
    open_alternative(number, elsewhere, "homes, and where that ends is not in the file");
    return;
  }
  if (!is_harmless(line)) {
    doubt(number, "is a command of the controller ('" + std::string{line} + "') whose effect cannot be followed");
  }
}

void ProgramState::note_words(std::uint32_t number, const std::vector<LineWord>& words) {
  constexpr std::string_view kSticky = "XYZRPQFIJK";
  for (const LineWord& word : words) {
    if (!sets_motion(word)) continue;
    motion_word_ = std::string{word.letter} + std::string{word.digits};
    motion_word_line_ = number;
    if (!gcode::is_canned_cycle(reader_.state().modal.motion)) cycle_words_.clear();
  }
  if (!gcode::is_canned_cycle(reader_.state().modal.motion)) return;
  for (const LineWord& word : words) {
    if (kSticky.contains(word.letter)) cycle_words_[word.letter] = std::string{word.digits};
  }
}

void ProgramState::note_motion(const AxisValues& from, const AxisValues& to, const gcode::Feed& feed, float top_mm) {
  moved_mm_ += distance(from, to);
  history_.has_moved = true;
  ++history_.motions;
  history_.highest_mm = std::max({history_.highest_mm, from[kZ], top_mm});
  if (feed.rapid) return;
  history_.highest_cut_mm = std::max(history_.highest_cut_mm.value_or(top_mm), std::max(from[kZ], top_mm));
  const bool is_plunge = from[0] == to[0] && from[1] == to[1] && to[kZ] < from[kZ];
  const bool has_plain_feed = !feed.inverse_time && !feed.per_revolution && !feed.synchronized;
  if (!is_plunge || !has_plain_feed || feed.rate_mm_per_min <= 0) return;
  history_.plunge_mm_per_min =
      std::min(history_.plunge_mm_per_min.value_or(feed.rate_mm_per_min), feed.rate_mm_per_min);
}

void ProgramState::note_actions(std::uint32_t number, const AxisValues& from) {
  AxisValues at = from;
  const auto waits = [this] { was_waiting_ = true; };
  for (const gcode::Action& action : actions_) {
    std::visit(
        base::Overloaded{
            [&](const gcode::LinearMove& move) {
              note_motion(at, move.target_mm, move.feed, std::max(at[kZ], move.target_mm[kZ]));
              at = move.target_mm;
            },
            [&](const gcode::ArcMove& move) {
              note_motion(at, move.target_mm, move.feed, top_of(move, at));
              // A full circle ends where it began, and is a motion all the same.
              moved_mm_ += std::abs(move.radius_mm);
              at = move.target_mm;
            },
            [&](const gcode::ProbeMove& move) {
              history_.has_moved = true;
              at = move.target_mm;
              waits();
            },
            [&](const gcode::Dwell& dwell) {
              if (spindle_started_) history_.spin_up_s = dwell.dwell_s;
              waits();
            },
            [&](const gcode::SpindleChange& change) {
              spindle_started_ = change.direction != gcode::SpindleDirection::Off;
              if (spindle_started_) history_.spin_up_s = 0;
              waits();
            },
            [&](const gcode::CoolantChange& change) { was_waiting_ = was_waiting_ || change.waits; },
            [&](const gcode::WorkOffsetChange&) { history_.offset_line = number; },
            [&](const gcode::ToolSelect&) { history_.tool_line = number; },
            [&](const gcode::PortOutput& output) { history_.outputs[{output.digital, output.port}] = output.value; },
            [&](const gcode::ProgramPause&) { waits(); },
            [](const auto&) {},
        },
        action);
  }
  if (moved_mm_ > 0) spindle_started_ = false;
}

void ProgramState::settle_actions(std::uint32_t number) {
  for (const gcode::Action& action : actions_) {
    if (const auto* probe = std::get_if<gcode::ProbeMove>(&action)) {
      reader_.sync_position(probe->target_mm);
      open_alternative(number, probe->start_mm, "probes, and where that touched is not in the file");
    } else if (std::holds_alternative<gcode::ToolChange>(action)) {
      reader_.complete_tool_change();
      history_.tool_line = number;
      was_waiting_ = true;
    } else if (std::holds_alternative<gcode::PortWait>(action)) {
      was_waiting_ = true;
    } else if (std::holds_alternative<gcode::AlarmRequest>(action)) {
      doubt(number, "asks for an alarm");
    }
  }
}

}  // namespace kerf::job
