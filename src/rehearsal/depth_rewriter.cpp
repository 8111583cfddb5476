#include "rehearsal/depth_rewriter.hpp"

#include <cmath>
#include <utility>

#include "rehearsal/number_text.hpp"

namespace kerf::rehearsal {
namespace {

std::unexpected<TransformRefusal> refuse(const SourceLine& line, std::string reason) {
  return std::unexpected{TransformRefusal{.line = line.number, .reason = std::move(reason)}};
}

}  // namespace

DepthRewriter::DepthRewriter(double deeper_mm, const vocabulary::Dialect& dialect)
    : deeper_mm_(deeper_mm), dialect_(&dialect), reading_(dialect) {}

void DepthRewriter::restart() {
  reading_ = ProgramReading(*dialect_);
  motion_ = {};
  below_mm_ = 0;
}

DepthRewriter::Done DepthRewriter::on_line(SourceLine line, LineQueue& out) {
  LineText text(line.text);
  const auto facts = reading_.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (!facts->is_over && deeper_mm_ != 0) {
    if (auto done = rewrite(text, *facts, line, out); !done) return done;
    line.text = text.text();
    motion_.note(LineText(line.text));
  }
  out.put(std::move(line));
  return {};
}

DepthRewriter::Done DepthRewriter::rewrite(LineText& text, const LineFacts& facts, const SourceLine& line,
                                           LineQueue& out) {
  if (text.may_be_skipped() && facts.use != AxisUse::Nobody) {
    return refuse(line,
                  "A line with '/' may be skipped, and then the lines behind it start elsewhere. Take the '/' "
                  "away, or the line.");
  }
  if (facts.changes_tool) {
    if (const PlacedWord* const word = text.find_command('M', 6)) text.erase(*word);
  }
  switch (facts.use) {
    case AxisUse::Nobody:
    case AxisUse::ToolLength:
    case AxisUse::ToolTable: return {};
    case AxisUse::Machine:
    case AxisUse::Home:
      // There the machine's own heights hold.
      if (below_mm_ != 0 && !has_axis(facts.named, kZ) && facts.named != 0) {
        return refuse(line, "G53 or G28 goes along before the tool is up again. Have the program go up first.");
      }
      below_mm_ = 0;
      return {};
    case AxisUse::Line: return facts.is_rapid ? rapid(text, facts, line, out) : cut(text, facts, line, out);
    case AxisUse::Arc:
    case AxisUse::Spline: return cut(text, facts, line, out);
    case AxisUse::Cycle: {
      if (facts.modal.plane != gcode::Plane::XY) return refuse(line, "This cycle does not drill along Z.");
      if (below_mm_ != 0) return refuse(line, "A drilling cycle begins before the tool is up again.");
      if (const PlacedWord* const depth = text.find('Z')) {
        const double unit = unit_mm(facts.modal);
        text.replace(*depth, "Z" + length_text(depth->value - deeper_mm_ / unit, unit));
      }
      return {};
    }
    default: return refuse(line, "This line probes, threads or moves work zero, and cannot be done again deeper.");
  }
}

DepthRewriter::Done DepthRewriter::rapid(LineText& text, const LineFacts& facts, const SourceLine& line,
                                         LineQueue& out) {
  if (below_mm_ == 0) return {};
  const bool goes_up_only = facts.named == mask_of_axis(kZ) && !facts.modal.incremental;
  if (goes_up_only) {
    below_mm_ = 0;
    return {};
  }
  if (!facts.modal.incremental && !has_axis(facts.from.known, kZ)) {
    return refuse(line, "No line before has said with G90 where Z is.");
  }
  // Up to where the program believes to be, straight: from there on every rapid is the program's own.
  const double unit = unit_mm(facts.modal);
  const double height_mm = facts.modal.incremental ? below_mm_ : facts.from.mm[kZ];
  out.put_new("G0 Z" + length_text(height_mm / unit, unit), line);
  motion_.note(LineText("G0"));
  motion_.say(text, 0);
  below_mm_ = 0;
  return {};
}

DepthRewriter::Done DepthRewriter::cut(LineText& text, const LineFacts& facts, const SourceLine& line, LineQueue&) {
  const PlacedWord* const height = text.find('Z');
  const bool is_deep = std::abs(below_mm_ - deeper_mm_) < kLengthTolerance_mm;
  const bool stands_upright = facts.use == AxisUse::Arc && facts.modal.plane != gcode::Plane::XY;
  if (!is_deep && (height == nullptr || stands_upright)) {
    return refuse(line,
                  "A rapid goes down to where this cut begins, and the next pass begins deeper. Have the program "
                  "plunge with G1.");
  }
  if (height != nullptr && !facts.modal.incremental) {
    const double unit = unit_mm(facts.modal);
    text.replace(*height, "Z" + length_text(height->value - deeper_mm_ / unit, unit));
  } else if (height != nullptr && !is_deep) {
    const double unit = unit_mm(facts.modal);
    text.replace(*height, "Z" + length_text(height->value + (below_mm_ - deeper_mm_) / unit, unit));
  }
  below_mm_ = deeper_mm_;
  return {};
}

}  // namespace kerf::rehearsal
