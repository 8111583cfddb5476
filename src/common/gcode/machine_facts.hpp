#pragma once
// What parameters can ask of the machine besides the interpreter's own state.

#include <cstdint>
#include <optional>

#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/errors.hpp"

namespace kerf::gcode {

/// A setting as a number, if it is one.
struct SettingNumber {
  enum class Kind : std::uint8_t {
    Decimal,
    Whole,     // numbers, bit fields and choices: single bits can be asked for
    NotNumber  // texts, and also flags and axis masks
  };
  Kind kind = Kind::NotNumber;
  float value = 0.0F;
};

/// Whoever owns an interpreter may answer these; without an owner that does, the machine stands where the last block
/// ended, has no settings and no inputs.
class MachineFacts {
 public:
  MachineFacts() = default;
  MachineFacts(const MachineFacts&) = delete;
  MachineFacts& operator=(const MachineFacts&) = delete;
  virtual ~MachineFacts() = default;

  /// Where the machine stands right now, machine coordinates.
  [[nodiscard]] virtual vocabulary::AxisValues position_mm() const = 0;
  [[nodiscard]] virtual vocabulary::AxisMask homed_axes() const = 0;
  /// Every axis that has to be homed is.
  [[nodiscard]] virtual bool is_homed() const = 0;
  /// Number of the lowest bit of grblHAL's state word, from 1 on; 0 when idle.
  [[nodiscard]] virtual int state_number() const = 0;
  /// Nothing for settings that do not exist.
  [[nodiscard]] virtual std::optional<SettingNumber> setting(int id) const = 0;
  /// G65 P1 with S: takes the value over at once.
  [[nodiscard]] virtual vocabulary::ErrorCode write_setting(int id, float value) = 0;
};

}  // namespace kerf::gcode
