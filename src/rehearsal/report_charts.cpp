#include "rehearsal/report_charts.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/duration_text.hpp"
#include "rehearsal/plot.hpp"

namespace kerf::rehearsal {
namespace {

constexpr Rgb kText = 0x1F2933;
constexpr Rgb kSoftText = 0x66717D;
constexpr Rgb kTrack = 0xE9EDF1;
constexpr Rgb kLine = 0xC5CDD5;
constexpr Rgb kBar = 0x1D5FAA;

Area rectangle(double left, double top, double right, double bottom, Rgb fill) {
  return {.fill = fill, .corners = {{left, top}, {right, top}, {right, bottom}, {left, bottom}}};
}

}  // namespace

std::vector<Share> shares_of(const UseOfTime& use) {
  std::vector<Share> shares{{.name = "Cutting", .seconds = use.cutting_s, .colour = 0x1D5FAA},
                            {.name = "Rapids", .seconds = use.rapid_s, .colour = 0x9AA5B1},
                            {.name = "Dwells", .seconds = use.dwell_s, .colour = 0xB07A00},
                            {.name = "Tool changes", .seconds = use.tool_change_s, .colour = 0x8A3FA0},
                            {.name = "Standing", .seconds = use.other_s, .colour = 0xD1541B}};
  constexpr double kNothing_s = 0.05;
  std::erase_if(shares, [](const Share& share) { return share.seconds < kNothing_s; });
  return shares;
}

Drawing draw_shares(const std::vector<Share>& shares, double width_px) {
  constexpr double kHeight_px = 18;
  Drawing drawing{.width_px = width_px, .height_px = kHeight_px, .title = "What the time is spent on", .items = {}};
  double total_s = 0;
  for (const Share& share : shares) total_s += share.seconds;
  drawing.items.emplace_back(rectangle(0, 0, width_px, kHeight_px, kTrack));
  double left = 0;
  for (const Share& share : shares) {
    const double right = left + share.seconds / std::max(total_s, 1e-9) * width_px;
    // A white gap between two parts, as long as there is room for one.
    const double gap = right - left > 4 ? 1 : 0;
    drawing.items.emplace_back(rectangle(left, 0, right - gap, kHeight_px, share.colour));
    left = right;
  }
  return drawing;
}

Drawing draw_feeds(const std::vector<FeedBin>& feeds, double width_px) {
  constexpr double kHeight_px = 132;
  constexpr double kTop_px = 20;
  constexpr double kBottom_px = 34;
  constexpr double kMostSlot_px = 110;
  constexpr double kText_px = 11;
  const double slot = std::min(kMostSlot_px, width_px / std::max<double>(static_cast<double>(feeds.size()), 1));
  Drawing drawing{.width_px = width_px, .height_px = kHeight_px, .title = "Time by programmed feed", .items = {}};
  double most_s = 1e-9;
  for (const FeedBin& bin : feeds) most_s = std::max(most_s, bin.total_s);
  const double base = kHeight_px - kBottom_px;
  double left = 0;
  for (const FeedBin& bin : feeds) {
    const double height = std::max((base - kTop_px) * bin.total_s / most_s, 1.0);
    const double middle = left + slot / 2;
    drawing.items.emplace_back(rectangle(left + slot * 0.14, base - height, left + slot * 0.86, base, kBar));
    drawing.items.emplace_back(Label{.at = {middle, base - height - 5},
                                     .text = base::clock_text(bin.total_s),
                                     .size_px = kText_px,
                                     .colour = kText,
                                     .anchor = Anchor::Middle});
    drawing.items.emplace_back(Label{.at = {middle, base + 15},
                                     .text = "from " + paper_number(bin.from_mm_per_min),
                                     .size_px = kText_px,
                                     .colour = kSoftText,
                                     .anchor = Anchor::Middle});
    left += slot;
  }
  Strokes floor{.ink = {.colour = kLine, .width_px = 1}, .points = {}, .ends = {}};
  floor.add({{0, base}, {left, base}});
  drawing.items.emplace_back(std::move(floor));
  drawing.items.emplace_back(
      Label{.at = {0, kHeight_px - 3}, .text = "Programmed feed, mm/min", .size_px = kText_px, .colour = kSoftText});
  return drawing;
}

Drawing draw_scale(const PathColours& colours, double width_px) {
  constexpr double kBar_px = 10;
  constexpr double kHeight_px = 28;
  constexpr double kText_px = 11;
  Drawing drawing{.width_px = width_px, .height_px = kHeight_px, .title = colours.legend_title(), .items = {}};
  const double step = width_px / static_cast<double>(colours.layers());
  for (std::size_t layer = 0; layer < colours.layers(); ++layer) {
    const double left = static_cast<double>(layer) * step;
    drawing.items.emplace_back(rectangle(left, 0, left + step, kBar_px, colours.colour(layer)));
  }
  if (colours.scale().is_empty()) return drawing;
  const double base = kHeight_px - 4;
  drawing.items.emplace_back(
      Label{.at = {0, base}, .text = paper_number(colours.scale().least), .size_px = kText_px, .colour = kSoftText});
  drawing.items.emplace_back(Label{.at = {width_px, base},
                                   .text = paper_number(colours.scale().most),
                                   .size_px = kText_px,
                                   .colour = kSoftText,
                                   .anchor = Anchor::End});
  return drawing;
}

Drawing draw_bar(double share, Rgb colour) {
  constexpr double kWidth_px = 90;
  constexpr double kHeight_px = 8;
  Drawing drawing{.width_px = kWidth_px, .height_px = kHeight_px, .title = "", .items = {}};
  drawing.items.emplace_back(rectangle(0, 0, kWidth_px, kHeight_px, kTrack));
  const double filled = std::clamp(share, 0.0, 1.0) * kWidth_px;
  if (filled >= 0.1) drawing.items.emplace_back(rectangle(0, 0, filled, kHeight_px, colour));
  return drawing;
}

}  // namespace kerf::rehearsal
