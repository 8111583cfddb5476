#pragma once
// Writes several straight moves in place of one line of a program.

#include <string>
#include <vector>

#include "rehearsal/line_source.hpp"
#include "rehearsal/modal_motion.hpp"

namespace kerf::rehearsal {

/// The first move keeps everything else that the line said; the rest follow on lines of their own. Increments never add
/// up their rounding.
class PolylineWriter {
 public:
  /// `line` was written as it is.
  void pass(const LineText& text, const LineFacts& facts);
  /// Moves to `places_mm` one after the other with G `motion`, naming `axes`. Words of `dropped` go.
  void put(LineText text, const LineFacts& facts, const SourceLine& line, const std::vector<ExactValues>& places_mm,
           AxisMask axes, int motion, std::string_view dropped, LineQueue& out);
  /// Where the last of it leads, in the program's coordinates.
  [[nodiscard]] const ExactValues& written_mm() const { return written_mm_; }

 private:
  std::string axis_words(const LineFacts& facts, const ExactValues& place_mm, AxisMask axes, std::string_view gap);

  ModalMotion motion_;
  ExactValues written_mm_{};
};

}  // namespace kerf::rehearsal
