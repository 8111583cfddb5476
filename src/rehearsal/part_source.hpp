#pragma once
// A part of a program as a program of its own: what the lines before it did to the modes of the controller is said
// first.

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "common/motion/rules.hpp"
#include "rehearsal/line_source.hpp"
#include "rehearsal/modal_motion.hpp"
#include "sender/job/program_state.hpp"

namespace kerf::rehearsal {

struct ProgramPart {
  std::uint32_t first_line = 1;
  std::uint32_t last_line = std::numeric_limits<std::uint32_t>::max();
  /// The tool is brought to where the part begins: up, across, down again. Without it the part's own lines have to do
  /// that before they cut, and no tool is called.
  bool approaches = true;
  /// What stops spindle and coolant, and the program's end, follow behind the part.
  bool ends = false;
};

class PartSource : public LineSource {
 public:
  PartSource(std::unique_ptr<LineSource> before, ProgramPart part, const vocabulary::Dialect& dialect);
  std::expected<std::optional<SourceLine>, TransformRefusal> next() override;
  void rewind() override;
  void collect_warnings(std::deque<TransformWarning>& out) const override;

 private:
  using Done = std::expected<void, TransformRefusal>;
  /// What the lines before the part have done.
  struct Past {
    ProgramReading reading;
    job::ProgramState state;
    std::uint32_t renaming_line = 0;
    bool zero_was_selected = false;
    /// As T last named it.
    std::optional<int> tool{};
    /// As M6 last brought it.
    std::optional<int> tool_in_spindle{};
    std::string length_word{};
    std::optional<double> highest_mm{};
    double dwell_s = 0;
    /// Axes whose place some line has told.
    AxisMask told = 0;
    bool starts_spindle = false;
  };

  [[nodiscard]] Past fresh_past() const;
  /// Reads a line that is left out.
  Done pass(const SourceLine& line);
  void note(const LineText& text, const LineFacts& facts, std::uint32_t number);
  Done begin(const SourceLine& first);
  void say_modes(const SourceLine& like);
  void say_tool(const SourceLine& like);
  void say_spindle(const SourceLine& like);
  Done approach(const SourceLine& like);
  Done take(SourceLine line);
  void end(const SourceLine& like);

  std::unique_ptr<LineSource> before_;
  ProgramPart part_;
  const vocabulary::Dialect* dialect_;
  Past past_;
  /// Reads what is written, from an unknown place.
  ProgramReading written_;
  ModalMotion motion_;
  bool has_begun_ = false;
  bool ended_ = false;
  SourceLine last_{};
  std::string wire_;
  LineQueue queue_;
};

}  // namespace kerf::rehearsal
