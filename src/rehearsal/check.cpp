#include "rehearsal/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/gcode/line_reader.hpp"
#include "common/motion/arc_extent.hpp"
#include "common/protocol/secrets.hpp"
#include "common/vocabulary/codes.hpp"
#include "rehearsal/check_rules.hpp"
#include "rehearsal/sent_lines.hpp"
#include "sender/job/line_words.hpp"
#include "sender/machine/explanation_evidence.hpp"

namespace kerf::rehearsal {
namespace {

using vocabulary::ErrorCode;

/// The rules that look at lines and moves.
using Rules =
    std::tuple<TravelRule, HeightRule, FeedRule, SpindleRule, LaserRule, ModeRule, PlaceRule, ProbeRule, StopRule>;

template <typename Do>
void for_each_rule(Rules& rules, const Do& act) {
  std::apply([&](auto&... rule) { (act(rule), ...); }, rules);
}

/// Which sort of refusal a code is.
FindingKind kind_of(ErrorCode code, bool has_unknown_word) {
  switch (code) {
    case ErrorCode::UndefinedFeedRate: return FindingKind::FeedMissing;
    case ErrorCode::UnsupportedCommand: return has_unknown_word ? FindingKind::UnknownWord : FindingKind::Refused;
    default: return FindingKind::Refused;
  }
}

struct EndOfAction {
  const gcode::Feed* feed = nullptr;
  const AxisValues* to_mm = nullptr;
  const gcode::ArcMove* arc = nullptr;
  bool probes = false;
};

EndOfAction end_of(const gcode::Action& action) {
  return std::visit(
      base::Overloaded{
          [](const gcode::LinearMove& move) { return EndOfAction{.feed = &move.feed, .to_mm = &move.target_mm}; },
          [](const gcode::ArcMove& move) {
            return EndOfAction{.feed = &move.feed, .to_mm = &move.target_mm, .arc = &move};
          },
          [](const gcode::ProbeMove& move) {
            return EndOfAction{.feed = &move.feed, .to_mm = &move.target_mm, .probes = true};
          },
          [](const auto&) { return EndOfAction{}; },
      },
      action);
}

/// Follows which places are known while the program runs, and where it goes.
class Whereabouts {
 public:
  explicit Whereabouts(const CheckMachine& machine) : machine_(machine), known_(machine.known_place) {
    min_mm_.fill(std::numeric_limits<float>::max());
    max_mm_.fill(std::numeric_limits<float>::lowest());
  }

  [[nodiscard]] AxisMask known() const { return known_; }
  [[nodiscard]] AxisMask lost() const { return lost_; }
  [[nodiscard]] std::uint32_t frame() const { return frame_; }

  /// The modes and words of a line decide what is known behind its moves.
  void on_move(const CheckedLine& line, const EndOfAction& end) {
    const AxisMask named = line.words.axes();
    if (line.words.machine_place && !machine_.knows_offsets) {
      forget(named == 0 ? all_axes() : named);
    } else if (end.probes) {
      forget(named);
    } else if (line.words.machine_place) {
      learn(named == 0 ? all_axes() : named);
    } else if (!line.after.modal.incremental) {
      learn(named);
    }
  }

  /// Axes that stay where they are have not been sent there by the program.
  void extend(const CheckedMove& move) {
    for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
      if (move.to_mm.at(axis) != move.from_mm.at(axis)) extend(move, axis, move.to_mm);
    }
    if (move.arc == nullptr) return;
    const auto plane = gcode::axes_of(move.arc->plane);
    if (!pokes_out(move, plane.first, 0) && !pokes_out(move, plane.second, 1)) return;
    for (const AxisValues& place : motion::extremes_of(motion::arc_of(*move.arc, move.from_mm))) {
      extend(move, plane.first, place);
      extend(move, plane.second, place);
    }
  }

  /// A line without motion: zeros may be set where the machine stands, or others chosen.
  void on_line(const CheckedLine& line) {
    if (line.words.sets_zero) learn(line.words.axes());
    const bool chooses = line.before.work_offset != line.after.modal.work_offset;
    if (!chooses || machine_.knows_offsets) return;
    known_ = 0;
    ++frame_;
  }

  /// Something moved the machine in a way that nobody can follow.
  void lose() { forget(all_axes()); }

  [[nodiscard]] std::vector<AxisExtent> extents() const {
    std::vector<AxisExtent> extents;
    for (std::size_t axis = 0; axis < kMaxAxes; ++axis) {
      if (min_mm_.at(axis) > max_mm_.at(axis)) continue;
      const auto rounded = [](float mm) { return std::round(static_cast<double>(mm) * 1000.0) / 1000.0; };
      extents.push_back({.axis = std::string(1, vocabulary::kAxisLetters[axis]),
                         .min_mm = rounded(min_mm_.at(axis)),
                         .max_mm = rounded(max_mm_.at(axis))});
    }
    return extents;
  }

 private:
  void extend(const CheckedMove& move, std::size_t axis, const AxisValues& place_mm) {
    if (!has_axis(move.known_to, axis)) return;
    const float work_mm = place_mm.at(axis) - move.work_offset_mm.at(axis);
    min_mm_.at(axis) = std::min(min_mm_.at(axis), work_mm);
    max_mm_.at(axis) = std::max(max_mm_.at(axis), work_mm);
  }
  /// The whole circle goes where the program has not been.
  [[nodiscard]] bool pokes_out(const CheckedMove& move, std::size_t axis, std::size_t which) const {
    const float radius = std::hypot(move.arc->center_offset_mm[0], move.arc->center_offset_mm[1]);
    const float center = move.from_mm.at(axis) + move.arc->center_offset_mm.at(which) - move.work_offset_mm.at(axis);
    return center - radius < min_mm_.at(axis) || center + radius > max_mm_.at(axis);
  }
  [[nodiscard]] AxisMask all_axes() const {
    return static_cast<AxisMask>((1U << static_cast<unsigned>(machine_.motion.axes)) - 1U);
  }
  void learn(AxisMask axes) {
    known_ = static_cast<AxisMask>(known_ | axes);
    lost_ = static_cast<AxisMask>(lost_ & ~axes);
  }
  void forget(AxisMask axes) {
    known_ = static_cast<AxisMask>(known_ & ~axes);
    lost_ = static_cast<AxisMask>(lost_ | axes);
  }

  const CheckMachine& machine_;
  AxisMask known_ = 0;
  AxisMask lost_ = 0;
  std::uint32_t frame_ = 0;
  AxisValues min_mm_{};
  AxisValues max_mm_{};
};

}  // namespace

class Checker::Reading {
 public:
  Reading(const job::Program& program, CheckMachine machine, job::WireForm form)
      : program_(program),
        machine_(std::move(machine)),
        lines_(program, form, machine_.tool_changes),
        reader_(machine_.reader),
        line_reader_(reader_.rules().line),
        whereabouts_(machine_),
        rules_(machine_, machine_, machine_, machine_, machine_, machine_, machine_, machine_, machine_) {
    is_doubtful_ = !machine_.knows_modes;
    StartupRule(machine_).begin(findings_);
  }

  bool read_on(std::size_t most_bytes) {
    const std::size_t enough = lines_.bytes_read() + most_bytes;
    while (lines_.bytes_read() < enough) {
      const auto line = lines_.next();
      if (!line) return false;
      ++result_.lines;
      if (!line->wire.empty() || line->tool_change) read(*line);
    }
    return true;
  }

  [[nodiscard]] double share_read() const {
    return static_cast<double>(lines_.bytes_read()) /
           static_cast<double>(std::max<std::size_t>(program_.size_bytes(), 1));
  }

  CheckResult finish() {
    for_each_rule(rules_, [&](auto& rule) {
      if constexpr (requires { rule.at_end(findings_); }) rule.at_end(findings_);
    });
    look_behind_end();
    result_.tools = std::get<StopRule>(rules_).tools();
    result_.extents = whereabouts_.extents();
    result_.groups = findings_.take();
    for (const FindingGroup& group : result_.groups) {
      (group.severity == Severity::Error     ? result_.errors
       : group.severity == Severity::Warning ? result_.warnings
                                             : result_.notes) += group.count;
    }
    return std::move(result_);
  }

 private:
  /// As the controller's own reader hands it on; nothing where it is too long.
  std::optional<std::string_view> as_read(std::string_view wire, bool is_plain) {
    // Most lines are already what the reader would make of them.
    if (is_plain && wire.size() <= reader_.rules().line.length_max) return wire;
    for (const char letter : wire) {
      if (const auto line = line_reader_.push(letter); line && line->overlong) {
        line_reader_.clear();
        return std::nullopt;
      }
    }
    const auto line = line_reader_.push('\n');
    if (!line) return std::string_view{};
    return line->overlong ? std::nullopt : std::optional{line->text};
  }

  void read(const SentLine& line) {
    CheckedLine checked{.number = line.number,
                        .text = line.text,
                        .wire = line.wire,
                        .words = words_seen_in(line.wire),
                        .before = reader_.state().modal,
                        .after = reader_.state()};
    if (line.tool_change) {
      std::get<StopRule>(rules_).on_tool_change(checked, line.tool_change->tool, findings_);
    }
    if (line.wire.empty()) return;
    const bool is_plain = !checked.words.has_lower_case && line.wire.front() != '/' && line.wire.front() != '$';
    const auto text = as_read(line.wire, is_plain);
    if (!text) return too_long(line);
    if (text->starts_with('$')) return command(line);
    if (!text->empty()) interpret(checked, *text);
  }

  void interpret(const CheckedLine& line, std::string_view text) {
    const AxisValues from = reader_.state().position_mm;
    actions_.clear();
    if (computes(line)) {
      static_cast<void>(reader_.interpret(text, actions_));
      return lose_track(line);
    }
    if (const auto read = reader_.interpret(text, actions_); !read) {
      refuse(line, text, read.error());
      return;
    }
    if (reader_.state().tool_change_pending) change_tool(line);
    whereabouts_.on_line(line);
    for_each_rule(rules_, [&](auto& rule) {
      if constexpr (requires { rule.on_line(line, Actions{actions_}, findings_); }) {
        rule.on_line(line, Actions{actions_}, findings_);
      }
    });
    follow(line, from);
  }

  void follow(const CheckedLine& line, AxisValues at_mm) {
    std::optional<AxisValues> offset;
    for (const gcode::Action& action : actions_) {
      const EndOfAction end = end_of(action);
      if (end.to_mm == nullptr) continue;
      if (!offset) offset = reader_.work_coordinate_offset();
      CheckedMove move{.line = line,
                       .from_mm = at_mm,
                       .to_mm = *end.to_mm,
                       .feed = *end.feed,
                       .arc = end.arc,
                       .known_from = whereabouts_.known(),
                       .lost_from = whereabouts_.lost(),
                       .work_offset_mm = *offset,
                       .frame = whereabouts_.frame()};
      whereabouts_.on_move(line, end);
      move.known_to = whereabouts_.known();
      move.lost_to = whereabouts_.lost();
      move.kind = end.probes ? MoveKind::Probe : cuts_.kind_of(move);
      whereabouts_.extend(move);
      for_each_rule(rules_, [&](auto& rule) {
        if constexpr (requires { rule.on_move(move, findings_); }) rule.on_move(move, findings_);
      });
      at_mm = *end.to_mm;
      ++result_.moves;
      if (end.probes) reader_.sync_position(at_mm);
    }
  }

  [[nodiscard]] bool computes(const CheckedLine& line) const {
    if (!reader_.rules().reads_expressions) return false;
    return line.words.has('O') || line.wire.find_first_of("#[") != std::string_view::npos;
  }

  void lose_track(const CheckedLine& line) {
    findings_.add(FindingKind::Computed, line.number, line.text,
                  [] { return "It uses parameters, expressions, subroutines or macros."; });
    is_doubtful_ = true;
    whereabouts_.lose();
  }

  void refuse(const CheckedLine& line, std::string_view text, ErrorCode error) {
    const int code = vocabulary::number_of(error);
    const auto unknown = machine::unknown_commands(text, *machine_.dialect);
    const FindingKind kind = kind_of(error, !unknown.empty());
    if (machine_.may_have_macros && job::needs_a_computer(line.wire, job::words_of(line.wire))) return lose_track(line);
    // Where the modes are not known, only what no mode can help is sure.
    if (is_doubtful_ && kind != FindingKind::UnknownWord) return;
    const auto* const row = vocabulary::find_code(machine_.dialect->errors, code);
    const auto what = [&]() -> std::string {
      if (kind == FindingKind::UnknownWord) {
        return std::string{machine_.dialect->name} + " has no " + unknown.front() + ".";
      }
      return row == nullptr ? "The controller refuses it." : std::string{row->title} + ".";
    };
    Finding* const kept = findings_.add(kind, line.number, line.text, what, "error:" + std::to_string(code));
    if (kept != nullptr && kept->next.empty() && row != nullptr) kept->next = row->text;
  }

  /// grblHAL raises the tool, or measures it, which wants homed axes (tool_change.c).
  void change_tool(const CheckedLine& line) {
    constexpr AxisMask kXyz = 0b111;
    const int mode = machine_.tool_change_mode;
    const AxisMask wanted = mode == 1 ? axis_bit(gcode::axes_of(reader_.state().modal.plane).linear) : kXyz;
    if (mode < 1 || mode > 3 || (machine_.homed_axes & wanted) == wanted) {
      reader_.complete_tool_change();
      return;
    }
    reader_.abort_tool_change();
    refuse(line, line.wire, ErrorCode::HomingRequired);
  }

  void too_long(const SentLine& line) {
    findings_.add(
        FindingKind::LineTooLong, line.number, line.text,
        [&] {
          return "It has " + std::to_string(line.wire.size()) + " characters without its comments; " +
                 std::string{machine_.dialect->name} + " takes " + std::to_string(machine_.dialect->line_length) + ".";
        },
        "error:11");
  }

  void command(const SentLine& line) {
    // It may hold a password.
    const std::string shown = protocol::Secrets{}.hidden(line.wire);
    findings_.add(FindingKind::ControllerCommand, line.number, shown, [&] { return "'" + shown + "' is no G-code."; });
    whereabouts_.lose();
  }

  /// Something to run that nobody sends.
  void look_behind_end() {
    if (lines_.end_line() == 0) return;
    constexpr int kMostLines = 10'000;
    auto end = program_.line(lines_.end_line());
    std::string wire;
    for (int count = 0; end && count < kMostLines; ++count) {
      const auto line = program_.line_at(program_.offset_after(*end), end->number + 1);
      if (!line) return;
      wire.clear();
      job::append_wire_form(wire, line->text, job::WireForm{});
      if (!wire.empty()) {
        findings_.add(FindingKind::BehindEnd, line->number, line->text,
                      [&] { return "The program ended at line " + std::to_string(lines_.end_line()) + "."; });
        return;
      }
      end = line;
    }
  }

  const job::Program& program_;
  CheckMachine machine_;
  SentLines lines_;
  gcode::Interpreter reader_;
  gcode::LineReader line_reader_;
  Whereabouts whereabouts_;
  CutWatch cuts_;
  Rules rules_;
  Findings findings_;
  CheckResult result_;
  std::vector<gcode::Action> actions_;
  /// Of the modes: what they are, only the controller knows.
  bool is_doubtful_ = false;
};

Severity CheckResult::worst() const {
  return groups.empty() ? Severity::Note : groups.front().severity;
}

Checker::Checker(const job::Program& program, CheckMachine machine)
    : Checker(program, machine, job::wire_form_of(*machine.dialect)) {}
Checker::Checker(const job::Program& program, CheckMachine machine, job::WireForm form)
    : reading_(std::make_unique<Reading>(program, std::move(machine), form)) {}
Checker::~Checker() = default;
Checker::Checker(Checker&&) noexcept = default;
Checker& Checker::operator=(Checker&&) noexcept = default;

bool Checker::read_on(std::size_t most_bytes) {
  return reading_->read_on(most_bytes);
}

double Checker::share_read() const {
  return reading_->share_read();
}

CheckResult Checker::finish() {
  return reading_->finish();
}

CheckResult check_program(const job::Program& program, const CheckMachine& machine) {
  constexpr std::size_t kPiece = 1U << 24U;
  Checker checker(program, machine);
  while (checker.read_on(kPiece)) {
  }
  return checker.finish();
}

}  // namespace kerf::rehearsal
