#include "rehearsal/transform.hpp"

#include <cmath>
#include <utility>

#include "common/base/overloaded.hpp"
#include "rehearsal/affine_rewriter.hpp"
#include "rehearsal/length_rewriter.hpp"
#include "rehearsal/word_rewriter.hpp"

namespace kerf::rehearsal {
namespace {

using Rewriter = std::unique_ptr<LineRewriter>;

Rewriter map_by(const Affine& map, std::string_view what, const vocabulary::Dialect& dialect) {
  return std::make_unique<AffineRewriter>(map, std::string{what}, dialect);
}

Rewriter rewriter_of(const TransformStep& step, const vocabulary::Dialect& dialect) {
  constexpr double kPercent = 100.0;
  return std::visit(
      base::Overloaded{
          [&](const Translate& by) { return map_by(translation(by.x_mm, by.y_mm, by.z_mm), "translated", dialect); },
          [&](const Rotate& by) {
            return map_by(rotation(by.angle_deg, by.about_x_mm, by.about_y_mm), "rotated", dialect);
          },
          [&](const Mirror& by) {
            return map_by(mirror(static_cast<std::size_t>(by.axis), by.at_mm), "mirrored", dialect);
          },
          [&](const Scale& by) { return map_by(scaling(by.x, by.y, by.z), "scaled", dialect); },
          [&](const ConvertUnits& units) -> Rewriter {
            return std::make_unique<LengthRewriter>(LengthStyle{.inches = units.to == LengthUnit::Inch}, dialect);
          },
          [&](const TrimDecimals& trim) -> Rewriter {
            return std::make_unique<LengthRewriter>(LengthStyle{.decimals = trim.decimals}, dialect);
          },
          [&](const StripComments&) -> Rewriter { return std::make_unique<CommentStripper>(dialect); },
          [](const ScaleFeed& by) -> Rewriter { return std::make_unique<WordScaler>('F', by.percent / kPercent); },
          [](const ScaleSpeed& by) -> Rewriter { return std::make_unique<WordScaler>('S', by.percent / kPercent); },
      },
      step);
}

bool is_length(double mm) {
  constexpr double kFarthest_mm = 1e5;
  return std::isfinite(mm) && std::abs(mm) <= kFarthest_mm;
}

bool is_factor(double factor) {
  constexpr double kLeast = 1e-3;
  constexpr double kMost = 1e3;
  return std::isfinite(factor) && factor >= kLeast && factor <= kMost;
}

}  // namespace

std::optional<std::string> fault_of(const TransformStep& step) {
  const auto unless = [](bool is_sound, std::string text) {
    return is_sound ? std::nullopt : std::optional<std::string>{std::move(text)};
  };
  const std::string lengths = "Lengths are up to 100 metres.";
  return std::visit(base::Overloaded{
                        [&](const Translate& by) {
                          return unless(is_length(by.x_mm) && is_length(by.y_mm) && is_length(by.z_mm), lengths);
                        },
                        [&](const Rotate& by) {
                          return unless(is_length(by.about_x_mm) && is_length(by.about_y_mm) && is_length(by.angle_deg),
                                        lengths);
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
                        [](const auto&) { return std::optional<std::string>{}; },
                    },
                    step);
}

Transform::Transform(const job::Program& program, const std::vector<TransformStep>& steps,
                     const vocabulary::Dialect& dialect)
    : source_(std::make_unique<ProgramSource>(program)) {
  for (const TransformStep& step : steps) {
    source_ = std::make_unique<RewritingSource>(std::move(source_), rewriter_of(step, dialect));
  }
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
