#pragma once
// What M6 does on grblHAL beyond waiting: moves to the place of the change, touch off, and back (`$341` modes 1 to 3).

#include <cstdint>
#include <expected>
#include <string_view>

#include "firmware/board.hpp"
#include "firmware/step.hpp"

namespace kerf::firmware {

/// Plans the steps of a tool change; the foreground carries them out and comes back with ContinueToolChange where the
/// way on depends on what happened. Moves nothing itself (grblHAL tool_change.c).
class ToolChange {
 public:
  explicit ToolChange(Board& board) : board_(board) {}

  /// M6, the motion before it has ended. The last step puts the machine into state Tool.
  [[nodiscard]] Steps begin();
  /// `~` in state Tool, acknowledged: touch off, way back, or a warning. Call it only if is_guided().
  [[nodiscard]] Steps on_cycle_start();
  /// `$TPW`: probes the tool where it stands; the last step is the answer.
  [[nodiscard]] std::expected<Steps, ErrorCode> probe_plate();
  /// The steps after `phase`.
  [[nodiscard]] Steps go_on(ToolChangePhase phase);
  /// G10 wrote the selected work offset: that counts as a touch off.
  void note_work_offset_stored() { awaits_touch_off_ = awaits_touch_off_ && at_g30_; }
  /// Reset, 0x19, alarm: the change does not take place.
  void abandon();

  /// A mode that moves and measures, acknowledged by 0xA3: `~` does not simply end the change.
  [[nodiscard]] bool is_guided() const { return moves() && board_.tool_acknowledged; }

 private:
  enum class Mode : std::uint8_t { Plain, ManualTouchOff, AtToolSetter, Automatic, Ignored };

  [[nodiscard]] Mode mode() const;
  [[nodiscard]] bool moves() const { return mode() != Mode::Plain && mode() != Mode::Ignored; }
  [[nodiscard]] bool option(unsigned bit) const;
  [[nodiscard]] float number(int id) const { return static_cast<float>(board_.settings.number(id)); }
  [[nodiscard]] float home_of_linear_axis() const { return board_.home_position_mm.at(axes_.linear); }

  void rapid_to(Steps& steps, const AxisValues& target_mm);
  void feed_to(Steps& steps, const AxisValues& target_mm, float rate_mm_per_min);
  void probe_to(Steps& steps, float rate_mm_per_min, bool away, bool no_error);
  void raise(Steps& steps);
  void go_to_tool_setter(Steps& steps);
  [[nodiscard]] Steps leave_g30();
  [[nodiscard]] Steps touch_off();
  [[nodiscard]] Steps way_back();
  [[nodiscard]] Steps restart_outputs();
  [[nodiscard]] Steps after_first_contact(ToolChangePhase next, bool no_error);
  [[nodiscard]] Steps after_second_contact();
  [[nodiscard]] Steps after_plate();
  [[nodiscard]] Steps plate_failed();
  void take_length();
  void fail();
  void aim_below(float distance_mm);

  Board& board_;
  gcode::PlaneAxes axes_ = gcode::axes_of(gcode::Plane::XY);
  AxisValues target_mm_{};
  /// Where the change began; the linear axis as work position, so that a new length keeps the tip where it was.
  AxisValues previous_mm_{};
  AxisValues parser_place_mm_{};
  bool awaits_touch_off_ = false;
  bool at_g30_ = false;
  bool is_under_way_ = false;
};

}  // namespace kerf::firmware
