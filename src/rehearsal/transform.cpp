#include "rehearsal/transform.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/overloaded.hpp"
#include "rehearsal/affine_rewriter.hpp"
#include "rehearsal/arc_fitter.hpp"
#include "rehearsal/arc_flattener.hpp"
#include "rehearsal/depth_rewriter.hpp"
#include "rehearsal/height_rewriter.hpp"
#include "rehearsal/length_rewriter.hpp"
#include "rehearsal/repeating_source.hpp"
#include "rehearsal/word_rewriter.hpp"
#include "rehearsal/zero_rewriter.hpp"
#include "sender/job/program_start.hpp"

namespace kerf::rehearsal {
namespace {

using Source = std::unique_ptr<LineSource>;

constexpr double kPercent = 100.0;

Source passes(Source before, const RepeatDeeper& by, const vocabulary::Dialect& dialect) {
  std::vector<Round> rounds(static_cast<std::size_t>(by.passes));
  for (std::size_t pass = 0; pass < rounds.size(); ++pass) {
    rounds[pass].rewriter = std::make_unique<DepthRewriter>(static_cast<double>(pass) * by.step_mm, dialect);
  }
  return std::make_unique<RepeatingSource>(std::move(before), std::move(rounds), dialect);
}

Source copies(Source before, const CopyToZeros& to, const vocabulary::Dialect& dialect) {
  std::vector<Round> rounds(to.work_offsets.size());
  for (std::size_t copy = 0; copy < rounds.size(); ++copy) {
    rounds[copy].first_words = job::work_offset_name(to.work_offsets[copy]);
    rounds[copy].rewriter = std::make_unique<ZeroRewriter>(rounds[copy].first_words);
  }
  return std::make_unique<RepeatingSource>(std::move(before), std::move(rounds), dialect);
}

/// Puts a transform behind a source.
class StepMaker {
 public:
  StepMaker(Source before, const vocabulary::Dialect& dialect) : before_(std::move(before)), dialect_(dialect) {}

  Source operator()(const Translate& by) { return map(translation(by.x_mm, by.y_mm, by.z_mm), "translated"); }
  Source operator()(const Rotate& by) { return map(rotation(by.angle_deg, by.about_x_mm, by.about_y_mm), "rotated"); }
  Source operator()(const Mirror& by) { return map(mirror(static_cast<std::size_t>(by.axis), by.at_mm), "mirrored"); }
  Source operator()(const Scale& by) { return map(scaling(by.x, by.y, by.z), "scaled"); }
  Source operator()(const ConvertUnits& units) {
    return rewrite<LengthRewriter>(LengthStyle{.inches = units.to == LengthUnit::Inch}, dialect_);
  }
  Source operator()(const TrimDecimals& trim) {
    return rewrite<LengthRewriter>(LengthStyle{.decimals = trim.decimals}, dialect_);
  }
  Source operator()(const StripComments&) { return rewrite<CommentStripper>(dialect_); }
  Source operator()(const ScaleFeed& by) { return rewrite<WordScaler>('F', by.percent / kPercent); }
  Source operator()(const ScaleSpeed& by) { return rewrite<WordScaler>('S', by.percent / kPercent); }
  Source operator()(const ArcsToLines& arcs) { return rewrite<ArcFlattener>(arcs.tolerance_mm, dialect_); }
  Source operator()(const LinesToArcs& lines) { return rewrite<ArcFitter>(lines.tolerance_mm, dialect_); }
  Source operator()(const FollowHeights& heights) { return rewrite<HeightRewriter>(heights.map, dialect_); }
  Source operator()(const RepeatDeeper& by) { return passes(std::move(before_), by, dialect_); }
  Source operator()(const CopyToZeros& to) { return copies(std::move(before_), to, dialect_); }
  Source operator()(const RunFromLine& from) {
    return std::make_unique<PartSource>(std::move(before_), ProgramPart{.first_line = from.line}, dialect_);
  }
  Source operator()(const Outline& outline) {
    return std::make_unique<OutlineSource>(std::move(before_), outline.shape, outline.feed_mm_per_min, dialect_);
  }

 private:
  template <class Rewriter, class... Args>
  Source rewrite(Args&&... args) {
    return std::make_unique<RewritingSource>(std::move(before_),
                                             std::make_unique<Rewriter>(std::forward<Args>(args)...));
  }
  Source map(const Affine& by, std::string_view what) {
    return rewrite<AffineRewriter>(by, std::string{what}, dialect_);
  }

  Source before_;
  const vocabulary::Dialect& dialect_;
};

bool is_length(double mm) {
  constexpr double kFarthest_mm = 1e5;
  return std::isfinite(mm) && std::abs(mm) <= kFarthest_mm;
}

bool is_factor(double factor) {
  constexpr double kLeast = 1e-3;
  constexpr double kMost = 1e3;
  return std::isfinite(factor) && factor >= kLeast && factor <= kMost;
}

bool is_tolerance(double mm) {
  return std::isfinite(mm) && mm >= 1e-4 && mm <= 1.0;
}

}  // namespace

std::optional<std::string> fault_of(const TransformStep& step) {
  const auto unless = [](bool is_sound, std::string text) {
    return is_sound ? std::nullopt : std::optional<std::string>{std::move(text)};
  };
  const std::string lengths = "Lengths are up to 100 metres.";
  const std::string tolerances = "Tolerances are from 0.0001 to 1 mm.";
  return std::visit(
      base::Overloaded{
          [&](const Translate& by) {
            return unless(is_length(by.x_mm) && is_length(by.y_mm) && is_length(by.z_mm), lengths);
          },
          [&](const Rotate& by) {
            return unless(is_length(by.about_x_mm) && is_length(by.about_y_mm) && is_length(by.angle_deg), lengths);
          },
          [&](const Mirror& by) { return unless(is_length(by.at_mm), lengths); },
          [&](const Scale& by) {
            return unless(is_factor(by.x) && is_factor(by.y) && is_factor(by.z),
                          "Factors are from 0.001 to 1000; --mirror changes a sign.");
          },
          [&](const TrimDecimals& trim) {
            constexpr int kMost = 6;
            return unless(trim.decimals >= 0 && trim.decimals <= kMost, "Decimals are from 0 to 6.");
          },
          [&](const ScaleFeed& by) {
            return unless(is_factor(by.percent / 100.0), "Per cent are from 0.1 to 100000.");
          },
          [&](const ScaleSpeed& by) {
            return unless(is_factor(by.percent / 100.0), "Per cent are from 0.1 to 100000.");
          },
          [&](const ArcsToLines& arcs) { return unless(is_tolerance(arcs.tolerance_mm), tolerances); },
          [&](const LinesToArcs& lines) { return unless(is_tolerance(lines.tolerance_mm), tolerances); },
          [&](const FollowHeights& heights) { return unless(heights.map != nullptr, "There is no grid."); },
          [&](const RepeatDeeper& by) {
            constexpr int kMost = 1000;
            return unless(by.passes >= 1 && by.passes <= kMost && by.step_mm >= 0 && by.step_mm <= kPercent,
                          "Passes are from 1 to 1000, each up to 100 mm deeper.");
          },
          [&](const CopyToZeros& to) {
            const bool is_sound =
                !to.work_offsets.empty() &&
                std::ranges::all_of(to.work_offsets, [](std::uint8_t zero) { return zero < gcode::kMaxWorkOffsets; });
            return unless(is_sound, "Work zeros are G54 to G59.");
          },
          [&](const RunFromLine& from) { return unless(from.line >= 1, "Lines count from 1."); },
          [&](const Outline& outline) {
            return unless(is_length(outline.feed_mm_per_min) && outline.feed_mm_per_min >= 1,
                          "Feeds are from 1 mm/min.");
          },
          [](const StripComments&) { return std::optional<std::string>{}; },
          [](const ConvertUnits&) { return std::optional<std::string>{}; },
      },
      step);
}

Transform::Transform(const job::Program& program, const std::vector<TransformStep>& steps,
                     const vocabulary::Dialect& dialect, const std::optional<ProgramPart>& part)
    : source_(std::make_unique<ProgramSource>(program)) {
  for (const TransformStep& step : steps) source_ = std::visit(StepMaker(std::move(source_), dialect), step);
  if (part) source_ = std::make_unique<PartSource>(std::move(source_), *part, dialect);
}

std::expected<std::vector<ToolPart>, TransformRefusal> tool_parts(const job::Program& program,
                                                                  const vocabulary::Dialect& dialect) {
  ProgramSource source(program);
  ProgramReading reading(dialect);
  std::vector<ToolPart> by_change{{}};
  std::vector<ToolPart> by_name{{}};
  int named = 0;
  bool changes = false;
  while (const auto line = source.next()) {
    if (!*line) break;
    const std::uint32_t number = (*line)->number;
    const LineText text((*line)->text);
    const auto facts = reading.read(text, number);
    if (!facts) return std::unexpected{facts.error()};
    if (facts->is_over) break;
    const PlacedWord* const tool = text.find('T');
    if (tool != nullptr) named = tool->whole();
    const auto begin = [&](std::vector<ToolPart>& parts) {
      if (parts.back().tool == named) return;
      // What stands in front of the first tool belongs to it.
      if (parts.size() == 1 && parts.back().tool == 0) {
        parts.back().tool = named;
        return;
      }
      parts.back().part.last_line = number - 1;
      parts.push_back({.tool = named, .part = {.first_line = number}});
    };
    changes = changes || facts->changes_tool;
    if (facts->changes_tool) begin(by_change);
    if (tool != nullptr) begin(by_name);
  }
  std::vector<ToolPart> parts = changes ? std::move(by_change) : std::move(by_name);
  for (ToolPart& part : parts) {
    part.part.approaches = false;
    part.part.ends = &part != &parts.back();
  }
  return parts;
}

std::deque<TransformWarning> Transform::warnings() const {
  std::deque<TransformWarning> warnings;
  source_->collect_warnings(warnings);
  return warnings;
}

void append_line(std::string& text, const SourceLine& line, bool follows_line) {
  // The last line of the file had no end, and now there is one behind it.
  if (follows_line && !text.empty() && text.back() != '\n' && text.back() != '\r') text += '\n';
  text += line.text;
  text += line.end;
}

std::expected<std::string, TransformRefusal> transformed_text(const job::Program& program,
                                                              const std::vector<TransformStep>& steps,
                                                              const vocabulary::Dialect& dialect) {
  Transform transform(program, steps, dialect);
  std::string text;
  while (true) {
    const auto line = transform.next();
    if (!line) return std::unexpected{line.error()};
    if (!*line) return text;
    append_line(text, **line, true);
  }
}

}  // namespace kerf::rehearsal
