// Any program through any transform: no crash, no endless work, and what comes out is a program that the controller
// takes.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "rehearsal/transform.hpp"

namespace {

using namespace kerf::rehearsal;

/// A number from a byte, with some digits behind the point.
double some_mm(std::uint8_t byte) {
  return (byte - 128) * 0.37;
}

TransformStep step_of(std::uint8_t kind, std::uint8_t value) {
  static const auto kMap = std::make_shared<const HeightMap>(HeightMap{
      .x_mm = {-50, 0, 30, 60}, .y_mm = {-40, 5, 70}, .z_mm = {0, 0.1, -0.2, 0, 0.3, 0.4, 0, 0, -1, 0, 0.5, 1}});
  switch (kind % 16) {
    case 0: return Translate{some_mm(value), some_mm(value / 2), 0.5};
    case 1: return Rotate{value * 1.5, some_mm(value), 1};
    case 2: return Mirror{static_cast<MirrorAxis>(value % 3), some_mm(value)};
    case 3: return Scale{1 + value / 100.0, 1 + value / 100.0, 1.0 + value % 2};
    case 4: return ConvertUnits{static_cast<LengthUnit>(value % 2)};
    case 5: return TrimDecimals{value % 7};
    case 6: return StripComments{};
    case 7: return ScaleFeed{1.0 + value};
    case 8: return ScaleSpeed{1.0 + value};
    case 9: return ArcsToLines{0.01 + value / 300.0};
    case 10: return LinesToArcs{0.001 + value / 300.0};
    case 11: return FollowHeights{kMap};
    case 12: return RepeatDeeper{.passes = value % 3 + 1, .step_mm = value / 50.0};
    case 13: return CopyToZeros{{static_cast<std::uint8_t>(value % 6), 1}};
    case 14: return RunFromLine{static_cast<std::uint32_t>(value % 20 + 1)};
    default: return Outline{static_cast<OutlineShape>(value % 2)};
  }
}

/// What a transform wrote by its own rules it can read again.
void expect_readable(const std::string& text, const kerf::vocabulary::Dialect& dialect) {
  const auto program = kerf::job::Program::load("out.nc", text);
  if (!program) return;
  Transform again(**program, {Translate{}}, dialect);
  for (auto line = again.next(); line && *line; line = again.next()) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  constexpr std::size_t kHead = 5;
  constexpr std::size_t kMost = 4096;
  constexpr std::size_t kMostLines = 20'000;
  if (size < kHead || size > kMost) return 0;
  const auto& dialect = *kerf::vocabulary::all_dialects()[bytes[0] % 3];
  const auto program =
      kerf::job::Program::load("fuzz.nc", std::string{reinterpret_cast<const char*>(bytes + kHead), size - kHead});
  if (!program) return 0;
  std::vector<TransformStep> steps{step_of(bytes[1], bytes[2])};
  if (bytes[3] % 4 != 0) steps.push_back(step_of(bytes[3], bytes[4]));
  for (const TransformStep& step : steps) {
    if (fault_of(step)) return 0;
  }
  Transform transform(**program, steps, dialect);
  std::string text;
  std::size_t lines = 0;
  auto line = transform.next();
  for (; line && *line && lines < kMostLines; line = transform.next(), ++lines) append_line(text, **line, true);
  static_cast<void>(transform.warnings());
  if (line && !*line) expect_readable(text, dialect);
  if (const auto parts = tool_parts(**program, dialect)) {
    for (const ToolPart& part : *parts) {
      Transform one(**program, {}, dialect, part.part);
      for (auto next = one.next(); next && *next; next = one.next()) {
      }
    }
  }
  return 0;
}
