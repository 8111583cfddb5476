#pragma once
// For tests: a virtual controller on a bench, talked to in lines and virtual time.

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/text.hpp"
#include "firmware/personality.hpp"
#include "firmware/virtual_controller.hpp"

namespace kerf::firmware::testing {

using namespace std::chrono_literals;

/// A controller that is switched on, its start-up text read. Homing switches stand where they stand by default.
class Bench {
 public:
  explicit Bench(vocabulary::Firmware firmware, StoredState stored = factory(), Equipment equipment = {})
      : controller(personality_of(firmware), std::move(stored), std::move(equipment)) {
    controller.power_on(now);
    heard_at_start = hear();
  }

  /// The same on other hardware; `personality` outlives the bench.
  explicit Bench(const Personality& personality) : controller(personality, factory()) {
    controller.power_on(now);
    heard_at_start = hear();
  }

  /// A memory that was written before, with factory settings.
  static StoredState factory() {
    StoredState stored;
    stored.initialised = true;
    return stored;
  }

  /// Everything that was said since the last time, without empty lines.
  std::vector<std::string> hear() {
    std::vector<std::string> lines;
    const std::string bytes = controller.take_outbox();
    for (std::string_view line : base::split(bytes, '\n')) {
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (!line.empty()) lines.emplace_back(line);
    }
    return lines;
  }

  /// Sends one line and hears what comes at once.
  std::vector<std::string> say(std::string_view line) { return send(std::string{line} + "\n"); }
  std::vector<std::string> send(std::string_view bytes) {
    controller.on_bytes(now, bytes);
    controller.advance_to(now);
    return hear();
  }
  std::vector<std::string> wait(Duration time) {
    now += time;
    controller.advance_to(now);
    return hear();
  }
  void happens(const WorkcellEvent& event) { controller.submit(now, event); }

  /// The state word of a status report.
  std::string state() {
    const auto lines = send("?");
    if (lines.empty()) return "";
    const auto bar = lines.back().find('|');
    return lines.back().substr(1, bar - 1);
  }
  /// Goes on until the machine has nothing more to do; a minute of rest counts as that.
  void run_out() {
    while (controller.next_deadline() != kNever) {
      now = std::max(now, controller.next_deadline());
      controller.advance_to(now);
    }
  }

  Instant now{};
  VirtualController controller;
  std::vector<std::string> heard_at_start;
};

}  // namespace kerf::firmware::testing
