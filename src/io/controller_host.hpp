#pragma once
// Gives a virtual controller a clock: real time, a multiple of it, or "max".

#include <functional>
#include <string_view>

#include "firmware/virtual_controller.hpp"
#include "io/event_loop.hpp"
#include "io/speed.hpp"

namespace kerf::io {

/// Runs one VirtualController on an event loop. Belongs to the loop's thread.
///
/// At `max` the virtual clock runs with the real one while the machine rests. While it works, the clock jumps from
/// deadline to deadline, one loop turn each, so that bytes which have arrived are always read before time passes. After
/// every output it waits a moment for the peer, whose next line is usually on its way: otherwise the planner would run
/// dry between two lines, and a job would be cut slower than on a real machine.
class ControllerHost {
 public:
  ControllerHost(EventLoop& loop, firmware::VirtualController controller, Speed speed);

  /// What the controller sends. Set it before power_on().
  void on_output(std::function<void(std::string_view)> callback) { output_ = std::move(callback); }
  /// The same to its pendant.
  void on_pendant_output(std::function<void(std::string_view)> callback) { pendant_output_ = std::move(callback); }
  /// The non-volatile memory has changed.
  void on_stored(std::function<void(const firmware::StoredState&)> callback) { stored_ = std::move(callback); }

  void power_on();
  void receive(std::string_view bytes);
  void receive_from_pendant(std::string_view bytes);
  [[nodiscard]] const firmware::VirtualController& controller() const { return controller_; }

 private:
  [[nodiscard]] Instant virtual_now() const;
  [[nodiscard]] Instant real_time_of(Instant virtual_time) const;
  [[nodiscard]] bool may_jump() const;
  void jump();
  void on_timer();
  /// Hands over what the controller said; true if it said anything.
  bool hand_over_output();
  /// Hands over output and changed memory, and arms the timer.
  void settle();
  void arm();

  EventLoop& loop_;
  firmware::VirtualController controller_;
  const Speed speed_;
  Timer timer_;
  std::function<void(std::string_view)> output_;
  std::function<void(std::string_view)> pendant_output_;
  std::function<void(const firmware::StoredState&)> stored_;
  unsigned saved_revision_ = 0;
  /// The virtual clock read `virtual_began_` when the real one read `real_began_`.
  Instant real_began_{};
  Instant virtual_began_{};
  Instant last_input_{};     ///< real
  Instant patient_until_{};  ///< real: no jump before
};

}  // namespace kerf::io
