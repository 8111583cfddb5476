#pragma once
// Rewrites a program so that its tool goes the mapped way. What it cannot map truthfully it refuses.
//
// A place of the machine and a place of the program are two things: nobody knows where the machine stands before the
// first line, behind G28, G53 or a probe, and there the map has nothing to act on. An axis is "mapped" while the
// machine's coordinate is known to be the mapped one of what the program says. So:
//  - absolute words are mapped, whatever was before; incremental ones by the linear part.
//  - G28, G30 and G53 stay: the machine's own places do not move with the job. On the way to G28 the job's do.
//  - G92 and G10 L20 give the present place a name. Where that place is mapped its name is mapped too, and nothing
//    changes; where it is not (behind a probe, at the start) the words stay.
//  - G10 L2, G43 and G43.1 stay: they speak of zeros and tools, not of the job.
// Each line is read back with the same interpreter and has to lead where it should.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rehearsal/affine.hpp"
#include "rehearsal/line_source.hpp"
#include "rehearsal/modal_motion.hpp"

namespace kerf::rehearsal {

class AffineRewriter : public LineRewriter {
 public:
  /// `what` says what is done, for refusals: "translated".
  AffineRewriter(const Affine& map, std::string what, const vocabulary::Dialect& dialect);
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  std::expected<void, TransformRefusal> on_end(LineQueue& out) override;
  void restart() override;

 private:
  using Done = std::expected<void, TransformRefusal>;
  /// Words to write, by letter.
  using NewWords = std::vector<std::pair<char, std::string>>;

  Done rewrite(LineText& text, const LineFacts& facts, std::uint32_t number, LineQueue& out);
  Done rewrite_move(LineText& text, const LineFacts& facts, std::uint32_t number, LineQueue& out);
  Done rewrite_arc(LineText& text, const LineFacts& facts, std::uint32_t number);
  Done rewrite_cycle(LineText& text, const LineFacts& facts, std::uint32_t number);
  Done rewrite_spline(LineText& text, const LineFacts& facts, std::uint32_t number);
  Done rewrite_home(LineText& text, const LineFacts& facts, std::uint32_t number);
  Done rewrite_name(LineText& text, const LineFacts& facts, std::uint32_t number);
  /// A vector of two words in the plane of these axes.
  void write_vector(LineText& text, const LineFacts& facts, std::string_view letters, std::array<std::size_t, 2> axes);

  /// The words of the named axes become those of the axes that depend on them; `without` keeps its words.
  Done map_axes(LineText& text, const LineFacts& facts, std::uint32_t number, AxisMask without = 0);
  Done map_absolute(const LineFacts& facts, std::uint32_t number, AxisMask axes, NewWords& words);
  void map_incremental(const LineFacts& facts, AxisMask axes, NewWords& words);
  Done check_cut(const LineFacts& facts, std::uint32_t number, AxisMask except, LineQueue& out);
  Done check_mapped_increments(const LineFacts& facts, std::uint32_t number, LineQueue& out);
  Done prove(const LineText& text, const LineFacts& facts, std::uint32_t number, LineQueue& out);
  void rename(AxisMask axes);
  [[nodiscard]] std::unexpected<TransformRefusal> refuse(std::uint32_t number, const std::string& reason) const;

  Affine map_;
  std::string what_;
  const vocabulary::Dialect* dialect_;
  ProgramReading reading_;
  /// Reads what was written.
  ProgramReading proof_;
  AxisMask mapped_ = 0;
  /// What incremental words have to make up for, mm: rounding must not add up.
  ExactValues owed_mm_{};
  ModalMotion motion_;
};

}  // namespace kerf::rehearsal
