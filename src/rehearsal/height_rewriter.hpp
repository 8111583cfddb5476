#pragma once
// Lets a program follow a surface that was measured.

#include <memory>
#include <string>

#include "rehearsal/height_map.hpp"
#include "rehearsal/line_source.hpp"
#include "rehearsal/polyline_writer.hpp"

namespace kerf::rehearsal {

/// Each height becomes what it was, above the surface of the map. Moves are cut into pieces where the surface bends.
/// Cuts outside the grid are refused; rapids there keep the height of its edge.
class HeightRewriter : public LineRewriter {
 public:
  HeightRewriter(std::shared_ptr<const HeightMap> map, const vocabulary::Dialect& dialect);
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  void restart() override;

 private:
  std::expected<void, TransformRefusal> move(LineText text, const LineFacts& facts, const SourceLine& line,
                                             LineQueue& out);
  [[nodiscard]] std::string fault_of(const LineText& text, const LineFacts& facts) const;

  std::shared_ptr<const HeightMap> map_;
  const vocabulary::Dialect* dialect_;
  ProgramReading reading_;
  PolylineWriter writer_;
};

}  // namespace kerf::rehearsal
