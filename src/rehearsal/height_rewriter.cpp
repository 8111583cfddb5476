#include "rehearsal/height_rewriter.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

constexpr AxisMask kSpace = mask_of_axis(kX) | mask_of_axis(kY) | mask_of_axis(kZ);
/// Pieces follow the surface as closely as this.
constexpr double kTolerance_mm = 0.002;

}  // namespace

HeightRewriter::HeightRewriter(std::shared_ptr<const HeightMap> map, const vocabulary::Dialect& dialect)
    : map_(std::move(map)), dialect_(&dialect), reading_(dialect) {}

void HeightRewriter::restart() {
  reading_ = ProgramReading(*dialect_);
  writer_ = {};
}

std::string HeightRewriter::fault_of(const LineText& text, const LineFacts& facts) const {
  switch (facts.use) {
    case AxisUse::Arc:
      return "An arc cannot follow the surface. Turn arcs into lines first: --arcs-to-lines 0.002 in front of this "
             "transform.";
    case AxisUse::Cycle:
    case AxisUse::Spline:
    case AxisUse::Spindle:
      return "A cycle, spline or thread cannot follow the surface. Have the CAM program write plain moves.";
    case AxisUse::Probe:
    case AxisUse::NamesPlace:
    case AxisUse::NamesElsewhere:
    case AxisUse::OffsetValue:
      if ((facts.named & kSpace) == 0) return "";
      return "It measures or moves work zero, and the map was measured from another one. Do that before the program.";
    case AxisUse::Scaling: return "G51 scales in the controller. Take it out.";
    default: break;
  }
  if (text.may_be_skipped() && facts.use != AxisUse::Nobody) {
    return "A line with '/' may be skipped, and then the lines behind it start elsewhere. Take the '/' away, or the "
           "line.";
  }
  return "";
}

std::expected<void, TransformRefusal> HeightRewriter::on_line(SourceLine line, LineQueue& out) {
  LineText text(line.text);
  const auto facts = reading_.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (!facts->is_over) {
    if (std::string fault = fault_of(text, *facts); !fault.empty()) {
      return std::unexpected{TransformRefusal{.line = line.number, .reason = std::move(fault)}};
    }
    if (facts->use == AxisUse::Line && (facts->named & kSpace) != 0) return move(std::move(text), *facts, line, out);
    writer_.pass(text, *facts);
  }
  out.put(std::move(line));
  return {};
}

std::expected<void, TransformRefusal> HeightRewriter::move(LineText text, const LineFacts& facts,
                                                           const SourceLine& line, LineQueue& out) {
  const auto refuse = [&](std::string reason) {
    return std::unexpected{TransformRefusal{.line = line.number, .reason = std::move(reason)}};
  };
  if ((facts.to.known & kSpace) != kSpace) {
    if (!facts.is_rapid) {
      return refuse("It cuts before any line has said where X, Y and Z are. Have the program go there with G90 first.");
    }
    writer_.pass(text, facts);
    out.put(line);
    return {};
  }
  const bool has_begin = (facts.from.known & kSpace) == kSpace;
  const ExactValues& to = facts.to.mm;
  const ExactValues& from = has_begin ? facts.from.mm : to;
  for (const ExactValues* end : {&from, &to}) {
    if (facts.is_rapid || map_->covers((*end)[kX], (*end)[kY])) continue;
    return refuse("X" + base::to_fixed((*end)[kX], 3) + " Y" + base::to_fixed((*end)[kY], 3) +
                  " lies outside the measured grid, which reaches from X" + base::to_fixed(map_->x_mm.front(), 3) +
                  " Y" + base::to_fixed(map_->y_mm.front(), 3) + " to X" + base::to_fixed(map_->x_mm.back(), 3) + " Y" +
                  base::to_fixed(map_->y_mm.back(), 3) + ". Measure there too.");
  }
  std::vector<ExactValues> places_mm;
  bool changes_height = false;
  for (const double share : map_->cuts(from[kX], from[kY], to[kX], to[kY], kTolerance_mm)) {
    ExactValues place = to;
    for (std::size_t axis = 0; axis < place.size() && share < 1.0; ++axis) {
      place.at(axis) = from.at(axis) + share * (to.at(axis) - from.at(axis));
    }
    place[kZ] += map_->height_mm(place[kX], place[kY]);
    changes_height = changes_height || std::abs(place[kZ] - writer_.written_mm()[kZ]) > 1e-6;
    places_mm.push_back(place);
  }
  const auto axes = static_cast<AxisMask>(facts.named | (changes_height ? mask_of_axis(kZ) : AxisMask{0}));
  writer_.put(std::move(text), facts, line, places_mm, axes, facts.is_rapid ? 0 : 1, "", out);
  return {};
}

}  // namespace kerf::rehearsal
