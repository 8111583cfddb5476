#pragma once
// The lines that bring a machine to the beginning of a line in the middle of a program, step by step.

#include <optional>
#include <string>
#include <vector>

#include "sender/job/program_state.hpp"
#include "sender/job/resume_plan.hpp"

namespace kerf::job {

/// What the steps are made from: the state at the line, and what the plan has decided.
struct StepInputs {
  const ProgramState& state;
  const vocabulary::Dialect& dialect;
  /// The machine now, as its interpreter knows it.
  const gcode::Interpreter& present;
  float safe_height_mm = 0;
  /// Where a rapid downwards ends; empty if all of the way down is fed.
  std::optional<float> rapid_to_mm{};
  float plunge_mm_per_min = 0;
  float spin_up_s = 0;
  /// Word of the mode of motion, where a line needs it and it can stand alone.
  std::string motion_word{};
  bool is_laser = false;
  /// Work offsets of the journal are written back.
  bool writes_offsets = false;
  bool asks_for_position = false;
  std::string position_text{};
};

/// All steps from the check of the position to the modes, without GoOn.
[[nodiscard]] std::vector<ResumeStep> steps_to(const StepInputs& inputs);

/// A coordinate or length as any firmware reads it back: at most eight digits.
[[nodiscard]] std::string number_text(float value);

}  // namespace kerf::job
