#pragma once
// What can be done to a program before it is run: each transform is a value, a list of them makes one program out of
// another, line by line and in order. Whatever is not changed stays byte for byte as it was.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "common/vocabulary/dialect.hpp"
#include "rehearsal/height_map.hpp"
#include "rehearsal/line_source.hpp"
#include "rehearsal/outline_source.hpp"
#include "rehearsal/part_source.hpp"
#include "sender/job/program.hpp"

namespace kerf::rehearsal {

struct Translate {
  double x_mm = 0;
  double y_mm = 0;
  double z_mm = 0;
};
BOOST_DESCRIBE_STRUCT(Translate, (), (x_mm, y_mm, z_mm))

/// Counterclockwise, seen from above.
struct Rotate {
  double angle_deg = 0;
  double about_x_mm = 0;
  double about_y_mm = 0;
};
BOOST_DESCRIBE_STRUCT(Rotate, (), (angle_deg, about_x_mm, about_y_mm))

enum class MirrorAxis : std::uint8_t { X, Y, Z };
BOOST_DESCRIBE_ENUM(MirrorAxis, X, Y, Z)

/// The coordinate changes its sign about `at_mm`: left becomes right with X.
struct Mirror {
  MirrorAxis axis{};
  double at_mm = 0;
};
BOOST_DESCRIBE_STRUCT(Mirror, (), (axis, at_mm))

struct Scale {
  double x = 1;
  double y = 1;
  double z = 1;
};
BOOST_DESCRIBE_STRUCT(Scale, (), (x, y, z))

enum class LengthUnit : std::uint8_t { Mm, Inch };
BOOST_DESCRIBE_ENUM(LengthUnit, Mm, Inch)

struct ConvertUnits {
  LengthUnit to{};
};
BOOST_DESCRIBE_STRUCT(ConvertUnits, (), (to))

/// Lengths keep at most so many digits behind the point.
struct TrimDecimals {
  int decimals = 3;
};
BOOST_DESCRIBE_STRUCT(TrimDecimals, (), (decimals))

struct StripComments {};
BOOST_DESCRIBE_STRUCT(StripComments, (), ())

struct ScaleFeed {
  double percent = 100;
};
BOOST_DESCRIBE_STRUCT(ScaleFeed, (), (percent))

struct ScaleSpeed {
  double percent = 100;
};
BOOST_DESCRIBE_STRUCT(ScaleSpeed, (), (percent))

/// Chords leave their arc by no more than the tolerance.
struct ArcsToLines {
  double tolerance_mm = 0.002;
};
BOOST_DESCRIBE_STRUCT(ArcsToLines, (), (tolerance_mm))

/// Points and chords lie no farther than the tolerance from their arc.
struct LinesToArcs {
  double tolerance_mm = 0.002;
};
BOOST_DESCRIBE_STRUCT(LinesToArcs, (), (tolerance_mm))

struct FollowHeights {
  std::shared_ptr<const HeightMap> map;
};

/// So many passes in all, each deeper than the one before.
struct RepeatDeeper {
  int passes = 1;
  double step_mm = 0;
};
BOOST_DESCRIBE_STRUCT(RepeatDeeper, (), (passes, step_mm))

/// Once at each of these work zeros: 0 is G54.
struct CopyToZeros {
  std::vector<std::uint8_t> work_offsets;
};
BOOST_DESCRIBE_STRUCT(CopyToZeros, (), (work_offsets))

/// The rest of the program from a line on, with what it needs in front.
struct RunFromLine {
  std::uint32_t line = 1;
};
BOOST_DESCRIBE_STRUCT(RunFromLine, (), (line))

struct Outline {
  OutlineShape shape{};
  double feed_mm_per_min = 1000;
};
BOOST_DESCRIBE_STRUCT(Outline, (), (shape, feed_mm_per_min))

using TransformStep =
    std::variant<Translate, Rotate, Mirror, Scale, ConvertUnits, TrimDecimals, StripComments, ScaleFeed, ScaleSpeed,
                 ArcsToLines, LinesToArcs, FollowHeights, RepeatDeeper, CopyToZeros, RunFromLine, Outline>;

/// Wrong numbers in the steps themselves: a sentence.
[[nodiscard]] std::optional<std::string> fault_of(const TransformStep& step);

/// The transformed program as it comes into being. Memory is that of a few lines.
class Transform {
 public:
  /// `program` must outlive it; every step passes fault_of(). Lines are read as `dialect` reads them. With `part` only
  /// that part of what the steps make is given.
  Transform(const job::Program& program, const std::vector<TransformStep>& steps, const vocabulary::Dialect& dialect,
            const std::optional<ProgramPart>& part = std::nullopt);

  /// Nothing at the end; after a refusal nothing more.
  std::expected<std::optional<SourceLine>, TransformRefusal> next() { return source_->next(); }
  /// What was noticed so far, in the order of the steps.
  [[nodiscard]] std::deque<TransformWarning> warnings() const;

 private:
  std::unique_ptr<LineSource> source_;
};

/// What is done with one tool.
struct ToolPart {
  /// 0 before any is told.
  int tool = 0;
  ProgramPart part{};
};

/// The program cut where tools change: at M6, or at T where it has no M6. Numbers of lines are those of `program`.
[[nodiscard]] std::expected<std::vector<ToolPart>, TransformRefusal> tool_parts(const job::Program& program,
                                                                                const vocabulary::Dialect& dialect);

/// The whole text at once.
[[nodiscard]] std::expected<std::string, TransformRefusal> transformed_text(const job::Program& program,
                                                                            const std::vector<TransformStep>& steps,
                                                                            const vocabulary::Dialect& dialect);

/// Appends `line` as it goes into a file; `text` ends with the line before.
void append_line(std::string& text, const SourceLine& line, bool follows_line);

}  // namespace kerf::rehearsal
