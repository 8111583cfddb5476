// The lines that a grblHAL drilling cycle becomes (grblHAL core motion_control.c).

#include "common/gcode/acts.hpp"

namespace kerf::gcode {

namespace {

class Drilling {
 public:
  Drilling(const Block& block, BlockContext& context, const Feed& feed)
      : block_(block),
        context_(context),
        cycle_(context.state.canned),
        feed_(feed),
        at_(context.state.position_mm),
        linear_(block.plane.linear) {}

  /// Drills all holes; where the tool ends.
  AxisValues run() {
    float& height = at_[linear_];
    if (height < cycle_.retract_position_mm) {
      height = cycle_.retract_position_mm;
      move(true);
    }
    const float start_height = height;
    retract_to_ = context_.state.modal.retract == RetractMode::RPosition ? cycle_.retract_position_mm : start_height;
    at_ = block_.xyz;
    height = start_height;
    move(true);

    for (int left = block_.l; left-- > 0;) {
      if (height > cycle_.retract_position_mm) {
        height = cycle_.retract_position_mm;
        move(true);
      }
      drill_hole();
      if (left > 0 && context_.state.modal.incremental) {
        at_[block_.plane.first] += cycle_.target_mm[block_.plane.first];
        at_[block_.plane.second] += cycle_.target_mm[block_.plane.second];
        move(true);
      }
    }
    return at_;
  }

 private:
  void move(bool rapid) {
    feed_.rapid = rapid;
    context_.out.push_back(LinearMove{.target_mm = at_, .feed = feed_});
  }

  void drill_hole() {
    float& height = at_[linear_];
    const float bottom = cycle_.target_mm[linear_];
    float depth = height;
    while (depth > bottom) {
      const float before = depth;
      depth -= cycle_.delta_mm;
      if (depth < bottom) depth = bottom;
      height = depth;
      move(false);
      if (cycle_.dwell_s > 0.0F) context_.out.push_back(Dwell{.dwell_s = cycle_.dwell_s});
      const bool breaks_chip = block_.modal.motion == MotionMode::DrillChipBreak && height != bottom;
      height = breaks_chip ? height + context_.settings.g73_retract_mm : retract_to_;
      move(cycle_.rapid_retract);
      // A peck too small for the float's precision would never reach the bottom.
      if (depth == before || context_.out.size() > kActionsMax) break;
    }
  }

  /// A line cannot become more than this: pecks of nothing would fill memory where the firmware is busy for hours.
  static constexpr std::size_t kActionsMax = 200000;

  const Block& block_;
  BlockContext& context_;
  const CannedCycle& cycle_;
  Feed feed_;
  AxisValues at_;
  std::size_t linear_;
  float retract_to_ = 0.0F;
};

}  // namespace

void act_canned_cycle(Block& block, BlockContext& context, Feed feed) {
  block.xyz = Drilling(block, context, feed).run();
}

}  // namespace kerf::gcode
