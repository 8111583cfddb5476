#pragma once
// The outline of a job as a program: traced above the work before anything is cut, it shows where the job will lie.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rehearsal/line_source.hpp"
#include "rehearsal/program_survey.hpp"

namespace kerf::rehearsal {

enum class OutlineShape : std::uint8_t {
  Box,
  Hull,  ///< the shortest way around
};
BOOST_DESCRIBE_ENUM(OutlineShape, Box, Hull)

/// X and Y, mm.
using Corner = std::array<double, 2>;

/// The corners of the shortest way around all points, counterclockwise, the first one lowest and leftmost.
[[nodiscard]] std::vector<Corner> hull_of(std::vector<Corner> points);

class OutlineSource : public LineSource {
 public:
  OutlineSource(std::unique_ptr<LineSource> before, OutlineShape shape, double feed_mm_per_min,
                const vocabulary::Dialect& dialect);
  std::expected<std::optional<SourceLine>, TransformRefusal> next() override;
  void rewind() override;
  void collect_warnings(std::deque<TransformWarning>& out) const override;

 private:
  std::expected<void, TransformRefusal> collect();
  void add(const LineFacts& facts, const ProgramReading& reading);
  void add_corner(Corner corner);
  std::expected<void, TransformRefusal> write(const ProgramSurvey& survey);

  std::unique_ptr<LineSource> before_;
  OutlineShape shape_;
  double feed_mm_per_min_;
  const vocabulary::Dialect* dialect_;
  /// So many corners are kept before only those of their hull are.
  static constexpr std::size_t kMostCorners = 4096;
  std::vector<Corner> corners_;
  std::size_t most_corners_ = kMostCorners;
  std::optional<double> highest_cut_mm_;
  bool has_begun_ = false;
  LineQueue queue_;
};

}  // namespace kerf::rehearsal
