// The passes that a G76 becomes (grblHAL core motion_control.c).

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/gcode/acts.hpp"

namespace kerf::gcode {

namespace {

constexpr std::size_t kX = 0;
constexpr std::size_t kZ = 2;

class Threading {
 public:
  Threading(BlockContext& context, const Feed& feed)
      : context_(context),
        thread_(context.state.thread),
        feed_(feed),
        from_(context.state.position_mm),
        at_(from_),
        infeed_(std::tan(thread_.infeed_angle_deg * std::numbers::pi_v<float> / 180.0F)),
        depth_mm_(thread_.first_depth_mm),
        start_z_(from_[kZ] + thread_.depth_mm * infeed_) {
    const float whole_mm = thread_.end_z_mm - from_[kZ];
    const float taper_mm = whole_mm > 0.0F ? -thread_.end_taper_mm : thread_.end_taper_mm;
    entry_mm_ = thread_.tapers_entry ? taper_mm : 0.0F;
    exit_mm_ = thread_.tapers_exit ? taper_mm : 0.0F;
    length_mm_ = whole_mm + entry_mm_ + exit_mm_;
  }

  void run() {
    if (infeed_ != 0.0F) {
      at_[kZ] = start_z_ - depth_mm_ * infeed_;
      move();
    }
    const int passes = cutting_passes() + thread_.spring_passes;
    for (int pass = 1; pass <= passes; ++pass) {
      const float entry_mm = thread_.tapers_entry ? thread_.depth_mm : 0.0F;
      at_[kX] = from_[kX] + (thread_.peak_mm + depth_mm_ - entry_mm) * thread_.direction;
      move();
      cut();
      if (pass < passes) {
        go_back(pass + 1);
      } else {
        at_[kX] = from_[kX];
        move();
      }
    }
  }

 private:
  [[nodiscard]] float depth_of(int pass) const {
    return thread_.first_depth_mm * std::pow(static_cast<float>(pass), 1.0F / thread_.degression);
  }
  /// So many until the depth is reached; a degression that never gets there has an end all the same.
  [[nodiscard]] int cutting_passes() const {
    constexpr int kMost = 10000;
    int passes = 1;
    while (passes < kMost && depth_of(passes) < thread_.depth_mm) ++passes;
    return passes;
  }
  void move() {
    feed_.rapid = !feed_.synchronized;
    context_.out.push_back(LinearMove{.target_mm = at_, .feed = feed_});
  }
  void cut() {
    feed_.synchronized = true;
    if (thread_.tapers_entry) {
      at_[kX] += thread_.depth_mm * thread_.direction;
      at_[kZ] -= entry_mm_;
      move();
    }
    at_[kZ] += length_mm_;
    move();
    if (thread_.tapers_exit) {
      at_[kX] -= thread_.depth_mm * thread_.direction;
      at_[kZ] -= exit_mm_;
      move();
    }
    feed_.synchronized = false;
  }
  void go_back(int next_pass) {
    depth_mm_ = std::min(depth_of(next_pass), thread_.depth_mm);
    at_[kX] = from_[kX] + (depth_mm_ - thread_.depth_mm) * thread_.direction;
    move();
    at_[kZ] = start_z_ - (infeed_ != 0.0F ? depth_mm_ * infeed_ : 0.0F);
    move();
  }

  BlockContext& context_;
  const ThreadCycle& thread_;
  Feed feed_;
  AxisValues from_;
  AxisValues at_;
  float infeed_;
  float depth_mm_;
  float start_z_;
  float entry_mm_ = 0.0F;
  float exit_mm_ = 0.0F;
  float length_mm_ = 0.0F;
};

}  // namespace

void act_thread(BlockContext& context, Feed feed) {
  feed.rate_mm_per_min = context.state.thread.pitch_mm;
  feed.inverse_time = feed.per_revolution = false;
  feed.no_override = true;
  Threading(context, feed).run();
}

}  // namespace kerf::gcode
