// Splines of grblHAL become lines: the step along the curve halves or doubles until its middle lies close to the chord
// (grblHAL core motion_control.c, config.h).

#include <cmath>

#include "common/gcode/acts.hpp"

namespace kerf::gcode {

namespace {

constexpr float kStepMin = 0.002F;
constexpr float kStepMax = 0.1F;
constexpr float kTolerance = 0.1F;

using Point = std::array<float, 2>;

float between(float a, float b, float t) {
  return (1.0F - t) * a + t * b;
}

/// A cubic Bezier curve by de Casteljau's construction.
struct Curve {
  Point from;
  Point first;
  Point second;
  Point to;

  [[nodiscard]] Point at(float t) const {
    Point result{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const float ab = between(from[axis], first[axis], t);
      const float bc = between(first[axis], second[axis], t);
      const float cd = between(second[axis], to[axis], t);
      result[axis] = between(between(ab, bc, t), between(bc, cd, t), t);
    }
    return result;
  }
};

/// Is `middle` of the curve close to the middle of the chord?
bool is_straight(const Point& start, const Point& middle, const Point& end) {
  float distance = 0.0F;
  for (std::size_t axis = 0; axis < 2; ++axis) distance += std::fabs(middle[axis] - 0.5F * (start[axis] + end[axis]));
  return distance <= kTolerance;
}

struct Step {
  float t;
  Point point;
};

/// The next point after `t`, which lies at `start`, beginning with a step of the last size.
Step next_step(const Curve& curve, float t, const Point& start, float last_step) {
  Step step{.t = std::fmin(t + last_step, 1.0F), .point = {}};
  step.point = curve.at(step.t);
  bool reduced = false;
  while (step.t - t >= kStepMin) {
    const float middle_t = 0.5F * (t + step.t);
    const Point middle = curve.at(middle_t);
    if (is_straight(start, middle, step.point)) break;
    step = {.t = middle_t, .point = middle};
    reduced = true;
  }
  while (!reduced && step.t - t <= kStepMax) {
    const float further_t = t + 2.0F * (step.t - t);
    if (further_t >= 1.0F) break;
    const Point further = curve.at(further_t);
    if (!is_straight(start, step.point, further)) break;
    step = {.t = further_t, .point = further};
  }
  return step;
}

}  // namespace

void act_cubic_spline(const Block& block, BlockContext& context, const Feed& feed, const Point& first_control,
                      const Point& second_control) {
  AxisValues target = context.state.position_mm;
  const Curve curve{.from = {target[0], target[1]},
                    .first = first_control,
                    .second = second_control,
                    .to = {block.xyz[0], block.xyz[1]}};
  float t = 0.0F;
  float size = kStepMax;
  while (t < 1.0F) {
    const Step step = next_step(curve, t, {target[0], target[1]}, size);
    if (!(step.t > t)) break;
    size = step.t - t;
    t = step.t;
    target[0] = step.point[0];
    target[1] = step.point[1];
    context.out.push_back(LinearMove{.target_mm = target, .feed = feed});
  }
}

}  // namespace kerf::gcode
