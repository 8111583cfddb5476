#pragma once
// Writes the lengths of a program in another way without moving anything: in the other unit, or with fewer decimals.
// Rounding does not add up, and a line that would lead elsewhere keeps its numbers.

#include <cstdint>
#include <optional>
#include <string>

#include "rehearsal/line_source.hpp"

namespace kerf::rehearsal {

struct LengthStyle {
  /// Inches or not; nothing keeps what the program says.
  std::optional<bool> inches{};
  /// Most digits behind the point; nothing keeps what is needed.
  std::optional<int> decimals{};
};

class LengthRewriter : public LineRewriter {
 public:
  LengthRewriter(LengthStyle style, const vocabulary::Dialect& dialect);
  std::expected<void, TransformRefusal> on_line(SourceLine line, LineQueue& out) override;
  void restart() override;

 private:
  void rewrite(LineText& text, const LineFacts& facts);
  void rewrite_axes(LineText& text, const LineFacts& facts);
  void rewrite_other_lengths(LineText& text, const LineFacts& facts) const;
  void rewrite_feed(LineText& text, const LineFacts& facts) const;
  void rewrite_unit(LineText& text) const;
  void trim_other_numbers(LineText& text) const;
  [[nodiscard]] std::string written(double mm, const LineFacts& facts, const PlacedWord& word) const;
  [[nodiscard]] bool inches_out(const LineFacts& facts) const;
  [[nodiscard]] bool leads_elsewhere(const LineText& text, const LineFacts& facts, std::uint32_t number);
  void say_unit(const LineText& text, const SourceLine& line, LineQueue& out);

  LengthStyle style_;
  const vocabulary::Dialect* dialect_;
  ProgramReading reading_;
  ProgramReading proof_;
  ExactValues owed_mm_{};
  bool unit_is_said_ = false;
};

}  // namespace kerf::rehearsal
