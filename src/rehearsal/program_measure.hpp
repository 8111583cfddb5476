#pragma once
// How large a program is: where it cuts, how far it goes. For the summary in front of a transform.

#include <cstdint>

#include <boost/describe.hpp>

#include "rehearsal/line_source.hpp"
#include "rehearsal/toolpath.hpp"

namespace kerf::rehearsal {

/// Places are those of the program's words, with all its zeros (G54, G55 ...) laid upon each other; only of axes whose
/// place a line has told. Arcs count to their full extent.
struct ProgramSize {
  std::uint32_t lines = 0;
  PathBounds cutting{};
  /// Rapids too.
  PathBounds all{};
  double cutting_mm = 0;
  double rapid_mm = 0;
};
BOOST_DESCRIBE_STRUCT(ProgramSize, (), (lines, cutting_mm, rapid_mm))

/// Adds up lines as they come.
class ProgramMeasure {
 public:
  explicit ProgramMeasure(const vocabulary::Dialect& dialect) : reading_(dialect) {}
  std::expected<void, TransformRefusal> add(const SourceLine& line);
  [[nodiscard]] const ProgramSize& size() const { return size_; }

 private:
  void add_point(const vocabulary::AxisValues& machine_mm, AxisMask known, bool cuts);

  ProgramReading reading_;
  ProgramSize size_;
};

}  // namespace kerf::rehearsal
