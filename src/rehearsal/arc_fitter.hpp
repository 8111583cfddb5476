#pragma once
// Finds arcs in runs of short lines, as CAM programs write them for curves, and writes those.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rehearsal/line_source.hpp"
#include "rehearsal/modal_motion.hpp"

namespace kerf::rehearsal {

/// Only lines of G1 in G17 and G90 that say nothing but X, Y and the feed in force become arcs; each of their points
/// and each of their chords lies within the tolerance of the arc.
class ArcFitter : public LineRewriter {
 public:
  ArcFitter(double tolerance_mm, const vocabulary::Dialect& dialect);
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  std::expected<void, TransformRefusal> on_end(LineQueue& out) override;
  void restart() override;

 private:
  using Done = std::expected<void, TransformRefusal>;
  struct Spot {
    double x_mm = 0;
    double y_mm = 0;
  };
  struct Piece {
    SourceLine line;
    Spot to;
  };
  struct Circle {
    Spot center;
    double radius_mm = 0;
    bool clockwise = false;
  };

  [[nodiscard]] bool may_belong(const LineText& text, const LineFacts& facts) const;
  /// The arc of the first `pieces` of the run.
  [[nodiscard]] std::optional<Circle> circle_of(std::size_t pieces) const;
  [[nodiscard]] bool fits(const Circle& circle, std::size_t pieces) const;
  Done add(Piece piece, LineQueue& out);
  Done end_run(LineQueue& out);
  Done put_arc(const Circle& circle, LineQueue& out);
  /// As it is, but for the word of its motion where another one is in force now.
  Done put_line(SourceLine line, std::optional<int> motion, LineQueue& out);
  void note_feed(const LineText& text);

  double tolerance_mm_;
  const vocabulary::Dialect* dialect_;
  ProgramReading reading_;
  /// Reads what was written.
  ProgramReading proof_;
  ModalMotion motion_;
  Spot from_;
  std::vector<Piece> run_;
  /// Of all pieces but perhaps the last.
  std::optional<Circle> circle_;
  double unit_mm_ = 1;
  std::string feed_;
};

}  // namespace kerf::rehearsal
