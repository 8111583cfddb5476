#pragma once
// Gives a virtual controller a clock: real time, a multiple of it, or "max".

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/rig.hpp"
#include "firmware/virtual_controller.hpp"
#include "io/event_loop.hpp"
#include "io/speed.hpp"

namespace kerf::io {

/// Runs one VirtualController in its rig on an event loop. Belongs to the loop's thread.
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

  /// Somebody cut or restored the link.
  void on_link(std::function<void(firmware::LinkState)> callback) { link_ = std::move(callback); }
  /// An entry of the log. Without a reader the log is lost.
  void on_record(std::function<void(const firmware::RigRecord&)> callback) { record_ = std::move(callback); }
  /// A line that was given to `add()` or `play()` is done.
  void on_line_done(std::function<void(const firmware::Rig::LineDone&)> callback) { line_done_ = std::move(callback); }
  /// After every turn: there may be room again for bytes that wait outside.
  void on_turn(std::function<void()> callback) { turn_ = std::move(callback); }

  void power_on();
  void receive(std::string_view bytes);
  void receive_from_pendant(std::string_view bytes);
  /// Bytes that a link with back-pressure may hand over now.
  [[nodiscard]] std::size_t network_room() const;
  /// A script that plays from now on, and lines that are added to one while it plays.
  firmware::Rig::PlayerId play(firmware::RigRecordKind kind, std::string name, std::vector<firmware::ScriptLine> lines);
  void add(firmware::Rig::PlayerId player, firmware::ScriptLine line);
  void stop(firmware::Rig::PlayerId player) { rig_.stop(player); }

  [[nodiscard]] const firmware::VirtualController& controller() const { return rig_.controller(); }
  [[nodiscard]] const firmware::Rig& rig() const { return rig_; }
  /// What the controller's clock reads; power came at 0.
  [[nodiscard]] Instant virtual_now() const;

 private:
  [[nodiscard]] Instant real_time_of(Instant virtual_time) const;
  [[nodiscard]] bool may_jump() const;
  void jump();
  void on_timer();
  /// Hands over what the controller said; true if it said anything.
  bool hand_over_output();
  /// Hands over output, changed memory and everything else that happened, and arms the timer.
  void settle();
  void tell_what_happened();
  void arm();

  EventLoop& loop_;
  firmware::Rig rig_;
  const Speed speed_;
  Timer timer_;
  std::function<void(std::string_view)> output_;
  std::function<void(std::string_view)> pendant_output_;
  std::function<void(const firmware::StoredState&)> stored_;
  std::function<void(firmware::LinkState)> link_;
  std::function<void(const firmware::RigRecord&)> record_;
  std::function<void(const firmware::Rig::LineDone&)> line_done_;
  std::function<void()> turn_;
  unsigned saved_revision_ = 0;
  firmware::LinkState told_link_ = firmware::LinkState::Up;
  /// The virtual clock read `virtual_began_` when the real one read `real_began_`.
  Instant real_began_{};
  Instant virtual_began_{};
  Instant last_input_{};     ///< real
  Instant patient_until_{};  ///< real: no jump before
};

}  // namespace kerf::io
