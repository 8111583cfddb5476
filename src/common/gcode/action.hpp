#pragma once
// What a block asks the machine to do, in the order in which the firmware does it.
// Every position is in machine coordinates, mm (degrees on rotary axes); axes that the machine lacks stay 0.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "common/vocabulary/axis.hpp"

namespace kerf::gcode {

using vocabulary::AxisValues;

enum class Plane : std::uint8_t { XY, ZX, YZ };

/// First, second and perpendicular axis of a plane, right-handed: G18 is Z then X.
struct PlaneAxes {
  std::size_t first;
  std::size_t second;
  std::size_t linear;
};

[[nodiscard]] constexpr PlaneAxes axes_of(Plane plane) {
  switch (plane) {
    case Plane::XY: return {.first = 0, .second = 1, .linear = 2};
    case Plane::ZX: return {.first = 2, .second = 0, .linear = 1};
    case Plane::YZ: break;
  }
  return {.first = 1, .second = 2, .linear = 0};
}

enum class SpindleDirection : std::uint8_t { Off, Clockwise, Counterclockwise };

/// How fast a motion runs and what the spindle or laser does meanwhile.
struct Feed {
  bool rapid = false;
  /// mm/min; with inverse_time it is 1/min, with per_revolution mm per spindle turn.
  float rate_mm_per_min = 0.0F;
  bool inverse_time = false;
  bool per_revolution = false;
  /// The motion begins only while the spindle turns; without per_revolution it begins at the index of its encoder, and
  /// the rate is the pitch of a thread in mm.
  bool synchronized = false;
  /// Feed override does not act (jogs, probing).
  bool no_override = false;
  /// Programmed speed; 0 on motions that must not burn in laser mode.
  float spindle_rpm = 0.0F;
  SpindleDirection spindle = SpindleDirection::Off;
  /// M4 in laser mode: the power follows the speed.
  bool laser_dynamic = false;
  std::int32_t line_number = 0;

  bool operator==(const Feed&) const = default;
};

struct LinearMove {
  AxisValues target_mm{};
  Feed feed;
  bool operator==(const LinearMove&) const = default;
};

/// `turns` is 1 for the ordinary arc; grblHAL's P word makes it more.
struct ArcMove {
  AxisValues target_mm{};
  /// From the start to the centre, along the plane's first and second axis.
  std::array<float, 2> center_offset_mm{};
  float radius_mm = 0.0F;
  Plane plane = Plane::XY;
  bool clockwise = false;
  int turns = 1;
  Feed feed;
  bool operator==(const ArcMove&) const = default;
};

/// After it the owner calls Interpreter::sync_position with the place where the machine came to rest.
struct ProbeMove {
  AxisValues target_mm{};
  /// Where the parser stood: give this to sync_position if the probe never moved (ALARM:4).
  AxisValues start_mm{};
  Feed feed;
  bool away = false;
  bool no_error = false;
  bool operator==(const ProbeMove&) const = default;
};

/// Result of Interpreter::interpret_jog; the parser position follows only when the owner accepts it with sync_position.
struct JogMove {
  AxisValues target_mm{};
  Feed feed;
  bool operator==(const JogMove&) const = default;
};

/// Waits for the motion to finish first.
struct Dwell {
  float dwell_s = 0.0F;
  bool operator==(const Dwell&) const = default;
};

/// M3, M4, M5: waits for the motion to finish first.
struct SpindleChange {
  SpindleDirection direction = SpindleDirection::Off;
  float rpm = 0.0F;
  bool operator==(const SpindleChange&) const = default;
};

/// S with the spindle on, outside a laser motion: waits for the motion to finish first.
struct SpindleSpeedChange {
  float rpm = 0.0F;
  bool operator==(const SpindleSpeedChange&) const = default;
};

/// State after M7, M8, M9. `waits`: the motion finishes first; Rabbit's M9 does not wait.
struct CoolantChange {
  bool flood = false;
  bool mist = false;
  bool waits = true;
  bool operator==(const CoolantChange&) const = default;
};

/// The sum of work, G92 and tool offsets may have changed: the next status report owes a WCO.
struct WorkOffsetChange {
  bool operator==(const WorkOffsetChange&) const = default;
};

enum class StoredOffset : std::uint8_t { G54, G55, G56, G57, G58, G59, G59_1, G59_2, G59_3, G28, G30, G92 };

/// Non-volatile storage is written; Grbl waits for the motion to finish first. Offsets already has the value.
struct StoredOffsetWrite {
  StoredOffset which = StoredOffset::G54;
  bool operator==(const StoredOffsetWrite&) const = default;
};

/// G10 L1: an entry of grblHAL's tool table is written to non-volatile storage. Offsets already has the values.
struct ToolTableWrite {
  int tool = 0;
  bool operator==(const ToolTableWrite&) const = default;
};

/// T: the tool that the next M6 takes.
struct ToolSelect {
  int tool = 0;
  bool operator==(const ToolSelect&) const = default;
};

/// M6 with a tool other than the present one (grblHAL): motion finishes, then the machine waits in state Tool. The
/// owner calls Interpreter::complete_tool_change or abort_tool_change.
struct ToolChange {
  int tool = 0;
  bool operator==(const ToolChange&) const = default;
};

/// M0, M60 and, on grblHAL, M1 (optional).
struct ProgramPause {
  bool optional = false;
  bool operator==(const ProgramPause&) const = default;
};

/// M2, M30: spindle and coolant off; modal state is reset already. `restores_overrides` where the firmware puts
/// overrides back to 100 %.
struct ProgramEnd {
  bool restores_overrides = false;
  bool operator==(const ProgramEnd&) const = default;
};

/// grblHAL's `(MSG,text)`.
struct OperatorMessage {
  std::string text;
  bool operator==(const OperatorMessage&) const = default;
};

/// M48 to M53 on grblHAL: what overrides may act from here on; waits for the motion to finish first.
struct OverrideControl {
  bool feed_enabled = true;
  bool spindle_enabled = true;
  bool feed_hold_enabled = true;
  bool parking_enabled = true;
  bool operator==(const OverrideControl&) const = default;
};

/// M62 to M65, M67, M68 on grblHAL: a user output. `with_motion`: it changes when the next motion begins.
struct PortOutput {
  bool digital = true;
  bool with_motion = false;
  std::uint8_t port = 0;
  float value = 0.0F;
  bool operator==(const PortOutput&) const = default;
};

enum class WaitMode : std::uint8_t { Immediate, Rise, Fall, High, Low };

/// M66 on grblHAL: reads a user input, or waits for it for a while.
struct PortWait {
  bool digital = true;
  std::uint8_t port = 0;
  WaitMode mode = WaitMode::Immediate;
  float timeout_s = 0.0F;
  bool operator==(const PortWait&) const = default;
};

/// `%` alone on a line (grblHAL): a program begins or ends.
struct ProgramDemarcation {
  bool operator==(const ProgramDemarcation&) const = default;
};

/// grblHAL's `O1 ALARM [n]`: the alarm comes before the line's answer.
struct AlarmRequest {
  int code = 0;
  bool operator==(const AlarmRequest&) const = default;
};

using Action =
    std::variant<LinearMove, ArcMove, ProbeMove, Dwell, SpindleChange, SpindleSpeedChange, CoolantChange,
                 WorkOffsetChange, StoredOffsetWrite, ToolTableWrite, ToolSelect, ToolChange, ProgramPause, ProgramEnd,
                 OperatorMessage, OverrideControl, PortOutput, PortWait, ProgramDemarcation, AlarmRequest>;

}  // namespace kerf::gcode
