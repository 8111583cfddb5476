#include "rehearsal/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "common/base/text.hpp"
#include "rehearsal/plot_sheet.hpp"

namespace kerf::rehearsal {
namespace {

constexpr std::size_t kVerticesAtOnce = 16'384;

/// One picture in the making.
struct Page {
  Page(const PlotOptions& options, const PathSummary& path)
      : colours(path, options.colour.value_or(telling_colour(path))),
        sheet(options, path, colours),
        painter(colours, options.view, sheet.projection(), sheet.paper_from(), sheet.paper_to()) {}

  PathColours colours;
  PlotSheet sheet;
  PathPainter painter;
};

std::string_view view_word(PlotView view) {
  switch (view) {
    case PlotView::Top: return "from above";
    case PlotView::Front: return "from the front";
    case PlotView::Side: return "from the right";
    case PlotView::Isometric: break;
  }
  return "in isometric view";
}

}  // namespace

double round_step(double value) {
  if (!(value > 1e-9) || value > 1e12) return value > 1 ? 1e12 : 1e-9;
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-12));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= value * (1 + 1e-9)) return digit * power;
  }
  return power;
}

std::string paper_number(double value) {
  const double size = std::abs(value);
  const int decimals = size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.9995 ? 2 : 3;
  std::string text = base::to_fixed(value, decimals);
  if (decimals > 0) {
    while (text.ends_with('0')) text.pop_back();
    if (text.ends_with('.')) text.pop_back();
  }
  if (!text.starts_with('-')) return text;
  constexpr std::string_view kMinus = "\xE2\x88\x92";
  return text == "-0" ? "0" : std::string{kMinus} + text.substr(1);
}

std::vector<Drawing> plot(std::string_view text, const PathStart& start, const PathSummary& path,
                          std::span<const PlotOptions> options) {
  // A page does not move: its painter refers to its colours.
  std::deque<Page> pages;
  for (const PlotOptions& wanted : options) pages.emplace_back(wanted, path);
  ToolpathReader reader(text, start);
  PathChunk chunk;
  for (bool goes_on = true; goes_on;) {
    goes_on = reader.read_on(chunk, kVerticesAtOnce);
    for (Page& page : pages) page.painter.add(chunk);
  }
  std::vector<Drawing> drawings;
  for (std::size_t at = 0; at < pages.size(); ++at) {
    Drawing& drawing = drawings.emplace_back();
    drawing.width_px = options[at].width_px;
    drawing.height_px = pages[at].sheet.height_px();
    drawing.title = "The toolpath of " + options[at].title + " " + std::string{view_word(options[at].view)};
    pages[at].sheet.draw_behind(drawing);
    pages[at].painter.finish(drawing, pages[at].sheet.line_px());
    pages[at].sheet.draw_before(drawing);
  }
  return drawings;
}

}  // namespace kerf::rehearsal
