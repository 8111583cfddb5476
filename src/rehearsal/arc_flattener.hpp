#pragma once
// Turns arcs into lines that leave them by no more than a tolerance.

#include <cstdint>
#include <string>

#include "rehearsal/line_source.hpp"
#include "rehearsal/polyline_writer.hpp"

namespace kerf::rehearsal {

class ArcFlattener : public LineRewriter {
 public:
  ArcFlattener(double tolerance_mm, const vocabulary::Dialect& dialect);
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  void restart() override;

 private:
  std::expected<void, TransformRefusal> flatten(LineText text, const LineFacts& facts, const SourceLine& line,
                                                LineQueue& out);
  double tolerance_mm_;
  const vocabulary::Dialect* dialect_;
  ProgramReading reading_;
  PolylineWriter writer_;
};

}  // namespace kerf::rehearsal
