#include "rehearsal/affine_rewriter.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/text.hpp"
#include "common/vocabulary/axis.hpp"
#include "rehearsal/number_text.hpp"

namespace kerf::rehearsal {
namespace {

using vocabulary::kAxisLetters;

constexpr std::string_view kMappedLetters = "XYZ";

std::string letters_of(AxisMask axes) {
  std::string letters;
  for (std::size_t axis = 0; axis < kAxisLetters.size(); ++axis) {
    if (!has_axis(axes, axis)) continue;
    if (!letters.empty()) letters += " and ";
    letters += kAxisLetters[axis];
  }
  return letters;
}

}  // namespace

AffineRewriter::AffineRewriter(const Affine& map, std::string what, const vocabulary::Dialect& dialect)
    : map_(map), what_(std::move(what)), dialect_(&dialect), reading_(dialect), proof_(dialect) {}

void AffineRewriter::restart() {
  reading_ = ProgramReading(*dialect_);
  proof_ = ProgramReading(*dialect_);
  mapped_ = 0;
  owed_mm_ = {};
  motion_ = {};
}

std::unexpected<TransformRefusal> AffineRewriter::refuse(std::uint32_t number, const std::string& reason) const {
  return std::unexpected{TransformRefusal{.line = number, .reason = "This cannot be " + what_ + ": " + reason}};
}

AffineRewriter::Done AffineRewriter::on_line(SourceLine line, LineQueue& out) {
  LineText text(std::move(line.text));
  const auto facts = reading_.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (!facts->is_over) {
    if (auto done = rewrite(text, *facts, line.number, out); !done) return done;
    const LineText written(text.text());
    if (auto done = prove(written, *facts, line.number, out); !done) return done;
    motion_.note(written);
  }
  line.text = text.text();
  out.put(std::move(line));
  return {};
}

AffineRewriter::Done AffineRewriter::on_end(LineQueue& out) {
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    if (map_.moves(axis) && !has_axis(mapped_, axis) && !has_axis(reading_.place().known, axis)) {
      out.warn(
          0, std::string{"No line says where "} + kAxisLetters[axis] + " is, so nothing of it could be " + what_ + ".");
    }
  }
  return {};
}

void AffineRewriter::rename(AxisMask axes) {
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    if (has_axis(map_.dependents_of(axes), axis) && !map_.keeps_distance(axis)) {
      mapped_ &= static_cast<AxisMask>(~mask_of_axis(axis));
    }
  }
}

AffineRewriter::Done AffineRewriter::rewrite(LineText& text, const LineFacts& facts, std::uint32_t number,
                                             LineQueue& out) {
  rename(facts.renamed);
  const bool matters = facts.use != AxisUse::Nobody || facts.renamed != 0 || text.has('G');
  if (text.may_be_skipped() && matters) {
    return refuse(number,
                  "a line with '/' at its beginning may be skipped, and then the lines behind it start "
                  "elsewhere. Take the '/' away, or the line.");
  }
  if (facts.modal.scaling || facts.use == AxisUse::Scaling) {
    return refuse(number, "G51 scales in the controller. Take it out.");
  }
  if (facts.stores_home) out.warn(number, "G28.1 or G30.1 stores a place of the job in the controller.");
  switch (facts.use) {
    case AxisUse::Nobody:
    case AxisUse::Scaling:
    case AxisUse::ToolLength: return {};
    case AxisUse::Line:
    case AxisUse::Probe: return rewrite_move(text, facts, number, out);
    case AxisUse::Arc: {
      if (auto done = rewrite_move(text, facts, number, out); !done) return done;
      return rewrite_arc(text, facts, number);
    }
    case AxisUse::Cycle: {
      if (auto done = check_mapped_increments(facts, number, out); !done) return done;
      const auto depth = mask_of_axis(gcode::axes_of(facts.modal.plane).linear);
      if (auto done = rewrite_cycle(text, facts, number); !done) return done;
      return check_cut(facts, number, depth, out);
    }
    case AxisUse::Spline: {
      if (auto done = rewrite_move(text, facts, number, out); !done) return done;
      return rewrite_spline(text, facts, number);
    }
    case AxisUse::Spindle: return refuse(number, "G33 and G76 cut threads with the spindle. Take them out.");
    case AxisUse::Machine: mapped_ &= static_cast<AxisMask>(~map_.dependents_of(facts.named)); return {};
    case AxisUse::Home: return rewrite_home(text, facts, number);
    case AxisUse::NamesPlace:
    case AxisUse::NamesElsewhere: return rewrite_name(text, facts, number);
    case AxisUse::OffsetValue: rename(facts.named); return {};
    case AxisUse::ToolTable: {
      if (text.find('L')->value == 1) return {};
      return refuse(number, "G10 L10 and L11 measure a tool by where the machine is. Take them out.");
    }
  }
  return {};
}

AffineRewriter::Done AffineRewriter::rewrite_move(LineText& text, const LineFacts& facts, std::uint32_t number,
                                                  LineQueue& out) {
  const bool upside_down = map_.linear[kZ][kZ] < 0 && has_axis(facts.named, kZ);
  if (upside_down && facts.use == AxisUse::Probe) return refuse(number, "the probe would go away from the work.");
  if (upside_down) out.warn(number, "Along Z what was above the work is below it now: look at every rapid.");
  if (auto done = check_mapped_increments(facts, number, out); !done) return done;
  if (auto done = map_axes(text, facts, number); !done) return done;
  if (facts.use == AxisUse::Probe) {
    mapped_ &= static_cast<AxisMask>(~map_.dependents_of(facts.named));
    return {};
  }
  return check_cut(facts, number, 0, out);
}

AffineRewriter::Done AffineRewriter::check_mapped_increments(const LineFacts& facts, std::uint32_t number,
                                                             LineQueue& out) {
  if (!facts.modal.incremental) return {};
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    if (!has_axis(map_.dependents_of(facts.named), axis) || map_.keeps(axis) || has_axis(mapped_, axis)) continue;
    const std::string letter{kAxisLetters[axis]};
    if (map_.moves(axis) && !facts.is_rapid) {
      return refuse(number, "it cuts along " + letter + " from wherever the machine stands, by G91. Have the program " +
                                "say with G90 where " + letter + " is before it cuts.");
    }
    out.warn(number, "Goes along " + letter + " from wherever the machine stands, by G91, and still begins there.");
  }
  return {};
}

AffineRewriter::Done AffineRewriter::check_cut(const LineFacts& facts, std::uint32_t number, AxisMask except,
                                               LineQueue& out) {
  if (facts.is_rapid) return {};
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    if (map_.keeps(axis) || has_axis(mapped_, axis) || has_axis(except, axis)) continue;
    const std::string letter{kAxisLetters[axis]};
    if (map_.moves(axis)) {
      return refuse(number, "it cuts before any line has said where " + letter + " is. Have the program go there " +
                                "with G90 first.");
    }
    if (!facts.modal.incremental) {
      out.warn(number, "Cuts before any line has said where " + letter + " is; that is where the machine stands.");
    }
  }
  return {};
}

AffineRewriter::Done AffineRewriter::map_axes(LineText& text, const LineFacts& facts, std::uint32_t number,
                                              AxisMask without) {
  const auto named = static_cast<AxisMask>(facts.named & ~without);
  const auto axes = static_cast<AxisMask>(map_.dependents_of(named) & ~without);
  NewWords words;
  const bool by_increments =
      facts.modal.incremental && facts.use != AxisUse::NamesPlace && facts.use != AxisUse::NamesElsewhere;
  if (by_increments) {
    map_incremental(facts, axes, words);
  } else if (auto done = map_absolute(facts, number, axes, words); !done) {
    return done;
  }
  std::string letters;
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    // Words that say what they said stand where they stood.
    const bool stays = by_increments ? map_.keeps_distance(axis) : map_.keeps(axis);
    if (!stays && !has_axis(without, axis)) letters += kMappedLetters[axis];
  }
  put_words(text, letters, std::move(words));
  return {};
}

AffineRewriter::Done AffineRewriter::map_absolute(const LineFacts& facts, std::uint32_t number, AxisMask axes,
                                                  NewWords& words) {
  const ProgramPlace target = pointed_at(facts);
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    if (!has_axis(axes, axis)) continue;
    if (const auto unknown = static_cast<AxisMask>(map_.inputs_of(axis) & ~target.known); unknown != 0) {
      return refuse(number, "it names " + letters_of(facts.named) + ", and no line has said where " +
                                letters_of(unknown) + " is. Name all of them with G90 first.");
    }
    mapped_ |= mask_of_axis(axis);
    if (map_.keeps(axis)) continue;
    const double unit = unit_mm(facts.modal);
    const double value_mm = map_.value(axis, target.mm);
    const std::string text = length_text(value_mm / unit, unit);
    owed_mm_.at(axis) = value_mm - base::parse_decimal(text).value_or(0) * unit;
    words.emplace_back(kMappedLetters[axis], text);
  }
  return {};
}

void AffineRewriter::map_incremental(const LineFacts& facts, AxisMask axes, NewWords& words) {
  const double unit = unit_mm(facts.modal);
  for (std::size_t axis = 0; axis < Affine::kAxes; ++axis) {
    if (!has_axis(axes, axis) || map_.keeps_distance(axis)) continue;
    const double way_mm = map_.distance(axis, facts.words_mm);
    // A full circle must end where it began.
    if (std::abs(way_mm) < kLengthTolerance_mm) {
      words.emplace_back(kMappedLetters[axis], "0");
      owed_mm_.at(axis) += way_mm;
      continue;
    }
    const double due_mm = way_mm + owed_mm_.at(axis);
    const std::string text = length_text(due_mm / unit, unit);
    owed_mm_.at(axis) = due_mm - base::parse_decimal(text).value_or(0) * unit;
    words.emplace_back(kMappedLetters[axis], text);
  }
}

}  // namespace kerf::rehearsal
