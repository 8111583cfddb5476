#pragma once
// The physical world around the machine: switches, buttons, door, probe and workpiece, as tests and the browser move
// them.

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "common/vocabulary/axis.hpp"

namespace kerf::firmware {

/// Inputs that are simply on or off. `ProbeDisconnected` is the plug of the probe pulled out (grblHAL `Pn:O`).
enum class Input : std::uint8_t {
  Probe,
  ProbeDisconnected,
  Door,
  FeedHold,
  CycleStart,
  Reset,
  EmergencyStop,
};
inline constexpr std::size_t kInputs = 7;

/// Somebody pressed, released, opened or closed something. An input stays as set.
struct InputChanged {
  Input input;
  bool active;
};

/// The limit switch of an axis (either end) is held down by hand, or let go.
struct LimitHeld {
  vocabulary::Axis axis;
  bool active;
};

/// Moves the homing switch of an axis: it closes while the axis is `distance_mm` or more away, in its homing direction,
/// from where the axis stood at power-on. Without a value the axis has no homing switch. By default it sits one axis
/// travel away.
struct HomingSwitchMoved {
  vocabulary::Axis axis;
  std::optional<double> distance_mm;
};

/// The motor of an axis does not follow: it stays this many steps behind a motion towards plus, or, below zero, behind
/// one towards minus. The controller does not notice.
struct StepsLost {
  vocabulary::Axis axis;
  std::int32_t steps = 0;
};

/// How a surface differs from a flat one. Heights are exact where a probe goes straight down; the place where a slanted
/// one touches is taken from the height below its start.
struct SurfaceShape {
  double tilt_x = 0;   ///< mm up for each mm along X
  double tilt_y = 0;   ///< the same along Y
  double wave_mm = 0;  ///< hills of this height and hollows as deep, side by side like the fields of a chessboard
  double wave_length_mm = 1;  ///< from hill to hill
};

/// Moves the surface that the probe touches: the probe closes while Z is at or below `z_mm`, counted from where Z stood
/// at power-on; `shape` is added, counted from where X and Y stood then. Without a value (the default) there is nothing
/// to touch.
struct ProbeSurfaceMoved {
  std::optional<double> z_mm;
  SurfaceShape shape{};
};

/// A user input (grblHAL M66) reads something else: 0 or 1, or an analog value.
struct PortInputChanged {
  bool digital = true;
  std::uint8_t port = 0;
  float value = 0;
};

/// The spindle turns at this share of the speed that it is told: 1 as it should, 0 it is stuck.
struct SpindleLoaded {
  double share = 1;
};

/// The encoder of the spindle counts, or its cable is off and it stands still.
struct EncoderPlugged {
  bool plugged = true;
};

using WorkcellEvent = std::variant<InputChanged, LimitHeld, HomingSwitchMoved, StepsLost, ProbeSurfaceMoved,
                                   PortInputChanged, SpindleLoaded, EncoderPlugged>;

/// What a controller's inputs read. Positions are physical: motor steps since power-on, which no homing or reset
/// redefines.
class Workcell {
 public:
  /// What turns steps and settings into the place of the homing switches; read at every question, so it may change any
  /// time.
  struct Geometry {
    std::size_t axes = 3;
    vocabulary::AxisValues steps_per_mm{};
    vocabulary::AxisValues travel_mm{};
    vocabulary::AxisMask homing_negative = 0;  ///< axes that home towards minus (`$23`)
  };

  void apply(const WorkcellEvent& event);

  [[nodiscard]] bool is_active(Input input) const { return inputs_[static_cast<std::size_t>(input)]; }
  [[nodiscard]] double spindle_share() const { return spindle_share_; }
  [[nodiscard]] bool is_encoder_plugged() const { return encoder_plugged_; }
  /// What a user input reads; 0 for one that nobody has set.
  [[nodiscard]] float port_input(bool digital, std::size_t port) const;
  /// Axes whose limit input is active with the motors at `physical` steps.
  [[nodiscard]] vocabulary::AxisMask limits_at(const vocabulary::AxisSteps& physical, const Geometry& geometry) const;
  [[nodiscard]] bool probe_at(const vocabulary::AxisSteps& physical, const Geometry& geometry) const;
  /// The physical step count of an axis at which its homing switch closes; none if it has no switch or is held by hand.
  [[nodiscard]] std::optional<std::int32_t> homing_switch_step(std::size_t axis, const Geometry& geometry) const;
  /// The physical Z step count at and below which the probe is closed by the surface under X and Y of `physical`.
  [[nodiscard]] std::optional<std::int32_t> surface_step(const vocabulary::AxisSteps& physical,
                                                         const Geometry& geometry) const;
  /// The motors lose power at `physical` and count from zero when it comes back: switches and surface stay where they
  /// are.
  void restart_count(const vocabulary::AxisSteps& physical);
  /// Motor steps that were made before the count began again, less those that were lost; together with those since they
  /// say where the machine is.
  [[nodiscard]] const vocabulary::AxisSteps& uncounted_steps() const { return uncounted_; }

 private:
  struct HomingSwitch {
    bool at_travel_end = true;
    std::optional<double> distance_mm;
  };

  static constexpr std::size_t kMostPorts = 16;

  std::array<bool, kInputs> inputs_{};
  std::array<float, kMostPorts> digital_{};
  std::array<float, kMostPorts> analog_{};
  double spindle_share_ = 1;
  bool encoder_plugged_ = true;
  vocabulary::AxisMask held_limits_ = 0;
  std::array<HomingSwitch, vocabulary::kMaxAxes> homing_switches_{};
  std::optional<double> surface_mm_;
  SurfaceShape surface_shape_;
  /// Motor steps that were made before the count began again, less those that were lost.
  vocabulary::AxisSteps uncounted_{};
};

}  // namespace kerf::firmware
