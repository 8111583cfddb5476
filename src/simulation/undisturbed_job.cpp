#include "simulation/undisturbed_job.hpp"

#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>

#include "common/base/text.hpp"
#include "firmware/personality.hpp"
#include "firmware/virtual_controller.hpp"
#include "simulation/switched_on.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using vocabulary::MachineState;

/// No line of a made-up job keeps a machine busy for so long.
constexpr Duration kLongestLine = 600s;

Point point_of(const vocabulary::AxisSteps& steps) {
  return {
      .x = steps[0] / kCampaignStepsPerMm, .y = steps[1] / kCampaignStepsPerMm, .z = steps[2] / kCampaignStepsPerMm};
}

class Rehearsal {
 public:
  explicit Rehearsal(const CampaignCase& made_up)
      : made_up_(made_up),
        controller_(firmware::personality_of(made_up.world.firmware), made_up.world.stored, made_up.world.equipment) {
    for (const auto& event : made_up.workcell) controller_.submit(now_, event);
    switch_on(controller_, now_, "");
  }

  UndisturbedJob run() {
    if (made_up_.homes) send("$H");
    job_.work_zero = place_of(controller_);
    const auto machine = controller_.position_steps();
    const auto& offset = made_up_.world.stored.offsets.at("G54");
    for (std::size_t axis = 0; axis < offset.size(); ++axis) {
      job_.machine_zero[axis] = job_.work_zero[axis] - machine[axis];
      job_.work_zero[axis] +=
          static_cast<std::int32_t>(std::lround(offset[axis] * kCampaignStepsPerMm)) - machine[axis];
    }
    watch_.emplace(job_.work_zero, kCampaignStepsPerMm);
    job_.path.push_back(point_of(machine));
    controller_.keep_motion_log();
    const Instant began = now_;
    for (const std::string_view line : base::split(made_up_.program, '\n')) {
      // Only grblHAL knows `%`, and it changes nothing.
      const std::string_view text = base::trim(line);
      if (!text.empty() && text != "%") send(line);
    }
    wait([this] { return controller_.state() == MachineState::Idle; }, "the end");
    job_.takes = now_ - began;
    for (const auto& piece : controller_.motion_log().stretches()) job_.path.push_back(point_of(piece.end_steps));
    job_.stock = watch_->stock();
    job_.complaints.insert(job_.complaints.end(), watch_->complaints().begin(), watch_->complaints().end());
    return std::move(job_);
  }

 private:
  void send(std::string_view line) {
    answered_ = false;
    controller_.on_bytes(now_, std::string{line} + "\n");
    wait([this] { return answered_; }, line);
  }

  template <class Done>
  void wait(const Done& done, std::string_view what) {
    const Instant limit = now_ + kLongestLine;
    for (;;) {
      listen();
      if (watch_) watch_->look(now_, controller_, true);
      go_on();
      if (done()) return;
      const Instant next = controller_.next_deadline();
      if (next > limit) break;
      now_ = std::max(now_, next);
      controller_.advance_to(now_);
    }
    job_.complaints.push_back("undisturbed, this never ends: " + std::string{what});
  }

  /// The operator is always ready.
  void go_on() {
    const bool waits = controller_.state() == MachineState::Tool ||
                       (controller_.state() == MachineState::Hold && controller_.substate().value_or(0) == 0);
    if (waits) controller_.on_bytes(now_, "~");
  }

  void listen() {
    const std::string heard = controller_.take_outbox();
    if (heard.empty()) return;
    for (const std::string_view raw : base::split(heard, '\n')) {
      const std::string_view line = base::trim(raw);
      const bool refused = line.starts_with("error:") || line.starts_with("ALARM:");
      if (refused) job_.complaints.push_back("undisturbed, the job gets " + std::string{line});
      answered_ |= line == "ok" || refused;
    }
  }

  const CampaignCase& made_up_;
  firmware::VirtualController controller_;
  UndisturbedJob job_;
  std::optional<CutterWatch> watch_;
  Instant now_{};
  bool answered_ = false;
};

}  // namespace

UndisturbedJob undisturbed(const CampaignCase& made_up) {
  return Rehearsal{made_up}.run();
}

}  // namespace kerf::simulation
