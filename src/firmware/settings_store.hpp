#pragma once
// The `$` settings of one controller: values, validation, and what motion and the interpreter make of them.

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/gcode/interpreter.hpp"
#include "common/motion/rules.hpp"
#include "common/vocabulary/settings.hpp"
#include "firmware/personality.hpp"
#include "firmware/stored_state.hpp"

namespace kerf::firmware {

/// Holds every setting that the firmware's reference build has, one slot a setting and axis, in the order of `$$`.
class SettingsStore {
 public:
  struct Slot {
    vocabulary::SettingMatch match;
    std::string text{};    ///< as `$$` prints it
    std::string format{};  ///< as `$ES` prints it
    double number = 0;     ///< of `text`; 0 for texts
  };

  explicit SettingsStore(const Personality& personality)
      : SettingsStore(personality, personality.dialect().axes_default) {}
  /// A machine with more axes than the usual build.
  SettingsStore(const Personality& personality, int axes);

  /// Defaults first, then what `stored` says. Returns the ids that this firmware does not have or refuses.
  std::vector<std::string> load(const StoredState& stored);
  /// Puts the values that differ from their defaults into `stored`.
  void save(StoredState& stored) const;

  /// Checks and takes over `$key=text`. On grblHAL an unknown key is error:53, elsewhere error:3.
  std::expected<void, ErrorCode> write(std::string_view key, std::string_view text);
  void restore_defaults();

  [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
  /// The slot that a key (`110`, `Homing/Enable`) names.
  [[nodiscard]] const Slot* find(std::string_view key) const;

  /// Value of setting `id` (of its axis `axis`); 0 if this firmware has none.
  /// `$32`=2 of grblHAL.
  [[nodiscard]] bool is_lathe() const;
  [[nodiscard]] double number(int id, int axis = 0) const;
  [[nodiscard]] bool flag(int id, unsigned bit = 0) const;
  /// Value of a setting that only has a name, radios by position; 0 if this firmware has none.
  [[nodiscard]] double number(std::string_view name) const;
  [[nodiscard]] unsigned mask(int id) const { return static_cast<unsigned>(static_cast<std::int64_t>(number(id))); }
  /// Values of a setting that each axis has, from X's id on.
  [[nodiscard]] vocabulary::AxisValues axis_values(int id) const;

  [[nodiscard]] int axes() const { return axes_; }
  /// Axes that turn (grblHAL `$376`).
  [[nodiscard]] vocabulary::AxisMask rotary_axes() const;
  [[nodiscard]] std::string_view format_of(const vocabulary::SettingMatch& match) const;
  [[nodiscard]] const Personality& personality() const { return personality_; }
  [[nodiscard]] motion::MotionSettings motion() const;
  /// Updates the settings that the interpreter depends on; the rest of `settings` stays.
  void configure(gcode::InterpreterSettings& settings) const;
  /// Built with an encoder, and `$38` gives it pulses.
  [[nodiscard]] bool has_spindle_encoder() const;

 private:
  [[nodiscard]] int axes_with_settings() const;
  std::expected<void, ErrorCode> write_obsolete(std::string_view text);
  [[nodiscard]] const Slot* slot_of(const vocabulary::SettingMatch& match) const;
  void set(const vocabulary::SettingMatch& match, std::string text);
  void apply_consequences();
  [[nodiscard]] bool is_laser() const;

  const Personality& personality_;
  std::span<const vocabulary::SettingRow> rows_;
  int axes_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> first_slot_;  ///< by row
};

/// A machine has the axes it was built with, and those whose steps per mm (`$103` on) were stored.
[[nodiscard]] int axes_of(const Personality& personality, const StoredState& stored);

/// Settings whose number means the same thing everywhere (protocol.md 7.2).
namespace setting {
inline constexpr int kIdleDelay = 1;
inline constexpr int kReportMask = 10;
inline constexpr int kJunctionDeviation = 11;
inline constexpr int kArcTolerance = 12;
inline constexpr int kReportInches = 13;
inline constexpr int kSoftLimits = 20;
inline constexpr int kHardLimits = 21;
inline constexpr int kHoming = 22;
inline constexpr int kHomingDirection = 23;
inline constexpr int kHomingFeed = 24;
inline constexpr int kHomingSeek = 25;
inline constexpr int kHomingDebounce = 26;
inline constexpr int kHomingPullOff = 27;
inline constexpr int kSpindleMax = 30;
inline constexpr int kSpindleMin = 31;
inline constexpr int kMode = 32;
inline constexpr int kSpindleUpDelay = 37;    // Rabbit
inline constexpr int kSpindleDownDelay = 38;  // Rabbit
inline constexpr int kFloodDelay = 60;        // Rabbit
inline constexpr int kMistDelay = 61;         // Rabbit
inline constexpr int kStepsPerMm = 100;
inline constexpr int kMaxRate = 110;
inline constexpr int kAcceleration = 120;
inline constexpr int kMaxTravel = 130;
inline constexpr int kBacklash = 180;  // Rabbit
// grblHAL only.
inline constexpr int kG73Retract = 28;
inline constexpr int kLegacyRealtime = 39;
inline constexpr int kLimitJogs = 40;
inline constexpr int kParking = 41;
inline constexpr int kParkingAxis = 42;
inline constexpr int kParkingPullOut = 56;
inline constexpr int kParkingPullOutRate = 57;
inline constexpr int kParkingTarget = 58;
inline constexpr int kParkingRate = 59;
inline constexpr int kRestoreOverrides = 60;
inline constexpr int kDoorOptions = 61;
inline constexpr int kSleepEnable = 62;
inline constexpr int kHoldActions = 63;
inline constexpr int kForceInitAlarm = 64;
inline constexpr int kProbeOptions = 65;
inline constexpr int kToolChangeMode = 341;
inline constexpr int kToolProbeDistance = 342;
inline constexpr int kToolProbeFeed = 343;
inline constexpr int kToolProbeSeek = 344;
inline constexpr int kToolProbePullOff = 345;
inline constexpr int kToolChangeOptions = 346;
inline constexpr int kRotaryAxes = 376;
inline constexpr int kG92Volatile = 384;
inline constexpr int kEncoderPulses = 38;  // grblHAL
inline constexpr int kSpindleAtSpeedTolerance = 340;
inline constexpr int kSpindleOnDelay = 394;
inline constexpr int kPlannerBlocks = 398;
inline constexpr int kAutoReport = 481;
inline constexpr int kLockedOffsets = 486;
inline constexpr int kKeepTool = 485;
inline constexpr int kSpindleOffDelay = 539;
inline constexpr int kCoolantOnDelay = 673;
inline constexpr int kDebugMessages = 534;
inline constexpr int kResetActions = 676;
}  // namespace setting

/// Bits of grblHAL's `$22`.
namespace homing_bit {
inline constexpr unsigned kEnable = 0;
inline constexpr unsigned kSingleAxis = 1;
inline constexpr unsigned kRequiredAtStart = 2;
inline constexpr unsigned kOriginZero = 3;
inline constexpr unsigned kManual = 5;
inline constexpr unsigned kOverrideLocks = 6;
inline constexpr unsigned kStartupLinesWhenHomed = 10;
}  // namespace homing_bit

// Named policies for Personality::check_setting.
std::expected<std::string, ErrorCode> check_setting_grbl(const SettingsStore& store,
                                                         const vocabulary::SettingMatch& match, std::string_view text);
std::expected<std::string, ErrorCode> check_setting_rabbit(const SettingsStore& store,
                                                           const vocabulary::SettingMatch& match,
                                                           std::string_view text);
std::expected<std::string, ErrorCode> check_setting_grblhal(const SettingsStore& store,
                                                            const vocabulary::SettingMatch& match,
                                                            std::string_view text);

}  // namespace kerf::firmware
