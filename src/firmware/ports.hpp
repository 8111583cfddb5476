#pragma once
// The user inputs and outputs that M62 to M68 work with (grblHAL).

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/gcode/action.hpp"

namespace kerf::firmware {

/// What the outputs are set to, and what waits for the next motion to set it. Inputs are read from the workcell.
class Ports {
 public:
  static constexpr std::size_t kMost = 16;

  void set(const gcode::PortOutput& output) {
    auto& bank = output.digital ? digital_ : analog_;
    bank.at(output.port % kMost) = output.value;
  }
  /// M62, M63, M67: set when block `number` begins, or a later one.
  void set_with_block(std::uint32_t number, const gcode::PortOutput& output) {
    waiting_.push_back({.block = number, .output = output});
  }
  void block_began(std::uint32_t number) {
    while (!waiting_.empty() && waiting_.front().block <= number) {
      set(waiting_.front().output);
      waiting_.pop_front();
    }
  }
  void forget_waiting() { waiting_.clear(); }

  [[nodiscard]] float digital(std::size_t port) const { return digital_.at(port % kMost); }
  [[nodiscard]] float analog(std::size_t port) const { return analog_.at(port % kMost); }

 private:
  struct Waiting {
    std::uint32_t block = 0;
    gcode::PortOutput output{};
  };

  std::array<float, kMost> digital_{};
  std::array<float, kMost> analog_{};
  std::deque<Waiting> waiting_;
};

}  // namespace kerf::firmware
