#pragma once
// The modal state of the interpreter: what stays in force from block to block.

#include <array>
#include <cstdint>
#include <optional>

#include "common/gcode/action.hpp"
#include "common/gcode/offsets.hpp"

namespace kerf::gcode {

enum class MotionMode : std::uint8_t {
  Rapid,
  Linear,
  ClockwiseArc,
  CounterclockwiseArc,
  ProbeToward,
  ProbeTowardNoError,
  ProbeAway,
  ProbeAwayNoError,
  DrillChipBreak,       // G73
  Drill,                // G81
  DrillDwell,           // G82
  DrillPeck,            // G83
  BoreFeedOut,          // G85
  BoreSpindleStop,      // G86
  BoreDwell,            // G89
  Tap,                  // G84
  CubicSpline,          // G5
  QuadraticSpline,      // G5.1
  SpindleSynchronized,  // G33
  RigidTap,             // G33.1
  Thread,               // G76
  None,                 // G80
};

/// Repeated by later blocks that have axis words only (grblHAL).
[[nodiscard]] constexpr bool is_canned_cycle(MotionMode mode) {
  switch (mode) {
    case MotionMode::DrillChipBreak:
    case MotionMode::Drill:
    case MotionMode::DrillDwell:
    case MotionMode::DrillPeck:
    case MotionMode::Tap:
    case MotionMode::BoreFeedOut:
    case MotionMode::BoreSpindleStop:
    case MotionMode::BoreDwell: return true;
    default: return false;
  }
}

enum class FeedMode : std::uint8_t { UnitsPerMinute, InverseTime, UnitsPerRevolution };
enum class ToolLengthMode : std::uint8_t { None, FromTable, Dynamic, Additional };
enum class RetractMode : std::uint8_t { Previous, RPosition };
enum class ProgramFlow : std::uint8_t { Running, Paused, OptionalStop, CompletedM2, CompletedM30, CompletedM60 };

struct Coolant {
  bool flood = false;
  bool mist = false;
  bool operator==(const Coolant&) const = default;
};

/// M48 to M56 of grblHAL: false means "locked".
struct OverridePermissions {
  bool feed = true;
  bool spindle = true;
  bool feed_hold = true;
  bool parking = true;
  bool operator==(const OverridePermissions&) const = default;
};

/// What a canned cycle remembers while it is repeated by later blocks. Machine coordinates, mm.
struct CannedCycle {
  /// Depth on the linear axis; on the others the way from the position before.
  AxisValues target_mm{};
  float retract_position_mm = 0.0F;
  float delta_mm = 0.0F;
  float dwell_s = 0.0F;
  bool rapid_retract = true;
  bool spindle_off = false;
  bool operator==(const CannedCycle&) const = default;
};

/// What G76 remembers while later blocks repeat it. Lengths in mm, X in radius.
struct ThreadCycle {
  float pitch_mm = 0.0F;
  float end_z_mm = 0.0F;
  float direction = 1.0F;  ///< of the cut along X
  float peak_mm = 0.0F;
  float first_depth_mm = 0.0F;
  float depth_mm = 0.0F;
  float degression = 1.0F;
  float infeed_angle_deg = 0.0F;
  float taper_height_mm = 0.0F;
  float end_taper_mm = 0.0F;
  bool tapers_entry = false;
  bool tapers_exit = false;
  int spring_passes = 0;
  bool operator==(const ThreadCycle&) const = default;
};

/// The part of the state that a block's words may change before it is known to be valid.
struct ModalState {
  MotionMode motion = MotionMode::Rapid;
  /// Later blocks repeat a canned cycle. grblHAL forgets to clear it at M2 and M30.
  bool canned_cycle = false;
  Plane plane = Plane::XY;
  bool inches = false;
  bool incremental = false;
  FeedMode feed_mode = FeedMode::UnitsPerMinute;
  /// 0 is G54.
  std::uint8_t work_offset = 0;
  ToolLengthMode tool_length = ToolLengthMode::None;
  RetractMode retract = RetractMode::Previous;
  bool scaling = false;
  /// Lathe: X words are diameters (G7).
  bool diameter = false;
  /// Lathe: S is a speed at the surface of the work (G96).
  bool surface_speed = false;
  SpindleDirection spindle = SpindleDirection::Off;
  Coolant coolant;
  OverridePermissions overrides;
  bool operator==(const ModalState&) const = default;
};

/// What M70 keeps for M72 (grblHAL).
struct SavedModalState {
  ModalState modal;
  float feed_rate = 0.0F;
  float spindle_rpm = 0.0F;
  AxisValues tool_length_mm{};
  bool operator==(const SavedModalState&) const = default;
};

/// A macro that G65, G66 or M98 named: grblHAL has a few built in.
struct MacroRequest {
  std::int32_t id = 0;
  std::uint8_t repeats = 1;
  /// The words that it gets as #1 to #26, as they were written: bit n is a letter, A the first.
  std::uint32_t words = 0;
  std::array<float, 26> values{};

  [[nodiscard]] bool has(char letter) const { return ((words >> static_cast<unsigned>(letter - 'A')) & 1U) != 0; }
  bool operator==(const MacroRequest&) const = default;
};

struct ParserState {
  ModalState modal;
  /// mm/min, or 1/min in inverse time mode.
  float feed_rate = 0.0F;
  float spindle_rpm = 0.0F;
  /// What the spindle was last told; G97 goes back to it.
  float commanded_rpm = 0.0F;
  /// G96: mm/min at the surface, and the rpm that D allows.
  float surface_mm_per_min = 0.0F;
  float surface_rpm_max = 0.0F;
  /// Present tool, as `T` of [GC:].
  std::uint32_t tool = 0;
  /// Tool that T selected for the next M6 (grblHAL).
  std::uint32_t tool_pending = 0;
  /// An M6 waits for the operator (grblHAL): motion answers error:40.
  bool tool_change_pending = false;
  /// The tool that this M6 brings; a failed line meanwhile forgets it, and the old tool stays.
  std::optional<std::uint32_t> arriving_tool;
  /// G43 in the block of that M6: the table entry whose length comes with the tool.
  std::optional<std::uint32_t> arriving_length;
  std::int32_t line_number = 0;
  /// Where the last block ends, machine coordinates.
  AxisValues position_mm{};
  /// Copy of the selected work offset: Grbl reads storage only when the selection changes.
  AxisValues work_offset_mm{};
  /// G51 (grblHAL).
  AxisValues scale_factor{1, 1, 1, 1, 1, 1, 1, 1};
  CannedCycle canned;
  ThreadCycle thread;
  std::optional<SavedModalState> saved;
  /// G66 is in force: motions call this macro.
  std::optional<MacroRequest> modal_macro;

  bool operator==(const ParserState&) const = default;
};

}  // namespace kerf::gcode
