#pragma once
// What a program's parameters may ask of the board.

#include "common/gcode/machine_facts.hpp"

namespace kerf::firmware {

struct Board;

/// Part of its board.
class BoardFacts final : public gcode::MachineFacts {
 public:
  explicit BoardFacts(Board& board) : board_(board) {}

  [[nodiscard]] vocabulary::AxisValues position_mm() const override;
  [[nodiscard]] vocabulary::AxisMask homed_axes() const override;
  [[nodiscard]] bool is_homed() const override;
  [[nodiscard]] int state_number() const override;
  [[nodiscard]] std::optional<gcode::SettingNumber> setting(int id) const override;
  [[nodiscard]] vocabulary::ErrorCode write_setting(int id, float value) override;

 private:
  Board& board_;
};

}  // namespace kerf::firmware
