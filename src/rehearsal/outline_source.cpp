#include "rehearsal/outline_source.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/motion/arc.hpp"
#include "common/motion/arc_extent.hpp"
#include "rehearsal/number_text.hpp"
#include "sender/job/program_start.hpp"

namespace kerf::rehearsal {
namespace {

constexpr AxisMask kPlane = mask_of_axis(kX) | mask_of_axis(kY);
double cross(const Corner& from, const Corner& one, const Corner& other) {
  return (one[0] - from[0]) * (other[1] - from[1]) - (one[1] - from[1]) * (other[0] - from[0]);
}

void add_chain(const std::vector<Corner>& sorted, std::vector<Corner>& hull) {
  const std::size_t before = hull.size();
  for (const Corner& point : sorted) {
    while (hull.size() >= before + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
    hull.push_back(point);
  }
  // The other chain begins with it.
  hull.pop_back();
}

/// The box around the corners of a hull.
std::vector<Corner> box_of(const std::vector<Corner>& corners) {
  Corner least = corners.front();
  Corner most = corners.front();
  for (const Corner& corner : corners) {
    for (std::size_t axis = 0; axis < least.size(); ++axis) {
      least.at(axis) = std::min(least.at(axis), corner.at(axis));
      most.at(axis) = std::max(most.at(axis), corner.at(axis));
    }
  }
  return {least, {most[0], least[1]}, most, {least[0], most[1]}};
}

}  // namespace

std::vector<Corner> hull_of(std::vector<Corner> points) {
  std::ranges::sort(points);
  const auto same = std::ranges::unique(points);
  points.erase(same.begin(), same.end());
  if (points.size() < 3) return points;
  std::vector<Corner> hull;
  add_chain(points, hull);
  std::ranges::reverse(points);
  add_chain(points, hull);
  return hull;
}

OutlineSource::OutlineSource(std::unique_ptr<LineSource> before, OutlineShape shape, double feed_mm_per_min,
                             const vocabulary::Dialect& dialect)
    : before_(std::move(before)), shape_(shape), feed_mm_per_min_(feed_mm_per_min), dialect_(&dialect) {}

void OutlineSource::rewind() {
  before_->rewind();
  corners_.clear();
  most_corners_ = kMostCorners;
  highest_cut_mm_.reset();
  has_begun_ = false;
  queue_.clear();
}

void OutlineSource::collect_warnings(std::deque<TransformWarning>& out) const {
  before_->collect_warnings(out);
  std::ranges::copy(queue_.warnings(), std::back_inserter(out));
}

void OutlineSource::add_corner(Corner corner) {
  corners_.push_back(corner);
  if (corners_.size() <= most_corners_) return;
  corners_ = hull_of(std::move(corners_));
  // A hull that is large itself must not be sought again at every corner.
  most_corners_ = std::max(kMostCorners, 2 * corners_.size());
}

void OutlineSource::add(const LineFacts& facts, const ProgramReading& reading) {
  if ((facts.to.known & kPlane) != kPlane || facts.is_rapid) return;
  if (facts.use != AxisUse::Line && facts.use != AxisUse::Arc && facts.use != AxisUse::Cycle &&
      facts.use != AxisUse::Spline) {
    return;
  }
  const bool goes_along = (facts.named & kPlane) != 0 || facts.use != AxisUse::Line;
  if (goes_along && has_axis(facts.to.known, kZ)) {
    highest_cut_mm_ = std::max(highest_cut_mm_.value_or(facts.to.mm[kZ]), facts.to.mm[kZ]);
  }
  if ((facts.from.known & kPlane) == kPlane && facts.use != AxisUse::Cycle) {
    add_corner({facts.from.mm[kX], facts.from.mm[kY]});
  }
  add_corner({facts.to.mm[kX], facts.to.mm[kY]});
  const gcode::ArcMove* const arc = reading.arc();
  if (arc == nullptr) return;
  const auto offset = reading.interpreter().work_coordinate_offset();
  constexpr float kTolerance_mm = 0.005F;
  constexpr float kShareOfRadius = 1e-5F;
  const auto add_place = [&](const vocabulary::AxisValues& place) {
    add_corner({static_cast<double>(place[kX] - offset[kX]), static_cast<double>(place[kY] - offset[kY])});
  };
  motion::Arc curve = motion::arc_of(*arc, facts.from_machine_mm);
  // More turns go the same way.
  curve.turns = std::min(curve.turns, 2);
  motion::ArcChords chords(
      curve, motion::rules_of(dialect_->firmware),
      {.axes = dialect_->axes_max, .arc_tolerance_mm = std::max(kTolerance_mm, curve.radius_mm * kShareOfRadius)});
  while (const auto place = chords.next()) add_place(*place);
  for (const auto& place : motion::extremes_of(curve)) add_place(place);
}

std::expected<void, TransformRefusal> OutlineSource::collect() {
  has_begun_ = true;
  const auto survey = survey_of(*before_, *dialect_);
  if (!survey) return std::unexpected{survey.error()};
  const std::uint32_t moved = survey->renaming_line != 0 ? survey->renaming_line : survey->zero_change_line;
  if (moved != 0) {
    return std::unexpected{TransformRefusal{
        .line = moved,
        .reason = "From here on places have other names (another work zero), and one outline cannot show "
                  "both. Outline the parts for themselves."}};
  }
  ProgramReading reading(*dialect_);
  while (true) {
    const auto line = before_->next();
    if (!line) return std::unexpected{line.error()};
    if (!*line) break;
    const auto facts = reading.read(LineText((*line)->text), (*line)->number);
    if (!facts) return std::unexpected{facts.error()};
    if (!facts->is_over) add(*facts, reading);
  }
  return write(*survey);
}

std::expected<void, TransformRefusal> OutlineSource::write(const ProgramSurvey& survey) {
  std::vector<Corner> corners = hull_of(std::move(corners_));
  corners_.clear();
  if (corners.empty()) {
    return std::unexpected{TransformRefusal{.line = 0, .reason = "Nothing is cut at a place that the program says."}};
  }
  if (shape_ == OutlineShape::Box) corners = box_of(corners);
  if (highest_cut_mm_ && survey.highest_mm && *survey.highest_mm <= *highest_cut_mm_) {
    return std::unexpected{TransformRefusal{
        .line = 0, .reason = "The program never goes higher than where it cuts, so the outline would be cut too."}};
  }
  const SourceLine like{.text = {}, .number = 1, .end = "\n"};
  const auto place = [](const Corner& corner) {
    return "X" + number_text(corner[0], kLengthTolerance_mm) + " Y" + number_text(corner[1], kLengthTolerance_mm);
  };
  queue_.put_new("(Outline: nothing is cut, the spindle stands still)", like);
  std::string modes = mode_words(gcode::ModalState{});
  const auto offset = survey.modal_at_motion ? survey.modal_at_motion->work_offset : std::uint8_t{0};
  if (offset != 0) (modes += ' ') += job::work_offset_name(offset);
  queue_.put_new(std::move(modes), like);
  queue_.put_new("M5", like);
  if (survey.highest_mm) queue_.put_new("G0 Z" + number_text(*survey.highest_mm, kLengthTolerance_mm), like);
  queue_.put_new("G0 " + place(corners.front()), like);
  std::string feed = " F" + number_text(feed_mm_per_min_, 1e-3);
  for (std::size_t at = 1; at <= corners.size(); ++at) {
    queue_.put_new("G1 " + place(corners[at % corners.size()]) + feed, like);
    feed.clear();
  }
  queue_.put_new("M30", like);
  return {};
}

std::expected<std::optional<SourceLine>, TransformRefusal> OutlineSource::next() {
  if (!has_begun_) {
    if (auto done = collect(); !done) return std::unexpected{done.error()};
  }
  if (queue_.is_empty()) return std::nullopt;
  return queue_.take();
}

}  // namespace kerf::rehearsal
