#pragma once
// One pass of a program that is repeated at deeper Z.

#include "rehearsal/line_source.hpp"
#include "rehearsal/polyline_writer.hpp"

namespace kerf::rehearsal {

/// What is fed goes deeper; rapids stay where they are, and so above the work as they were.
class DepthRewriter : public LineRewriter {
 public:
  DepthRewriter(double deeper_mm, const vocabulary::Dialect& dialect);
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  void restart() override;

 private:
  using Done = std::expected<void, TransformRefusal>;
  Done rewrite(LineText& text, const LineFacts& facts, const SourceLine& line, LineQueue& out);
  Done rapid(LineText& text, const LineFacts& facts, const SourceLine& line, LineQueue& out);
  Done cut(LineText& text, const LineFacts& facts, const SourceLine& line, LineQueue& out);

  double deeper_mm_;
  const vocabulary::Dialect* dialect_;
  ProgramReading reading_;
  ModalMotion motion_;
  /// The tool is so much below where the program says; nothing while that is not known.
  double below_mm_ = 0;
};

}  // namespace kerf::rehearsal
