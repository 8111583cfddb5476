#include "rehearsal/plot_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kerf::rehearsal {
namespace {

using Place = std::array<double, 3>;

constexpr Rgb kText = 0x1F2933;
constexpr Rgb kSoftText = 0x66717D;
constexpr Rgb kGrid = 0xECEFF2;
constexpr Rgb kZeroLine = 0xC5CDD5;
constexpr Rgb kBox = 0xC5CDD5;
constexpr Rgb kRapid = 0x9AA5B1;
constexpr std::array<Rgb, 3> kAxisColours = {0xC92A2A, 0x2B8A3E, 0x1864AB};
constexpr std::string_view kAxisNames = "XYZ";

constexpr double kPad_px = 28;
constexpr double kHeader_px = 76;
constexpr double kLegend_px = 248;
/// Work zero is shown too, unless the picture would become larger than this by it.
constexpr double kMostOfZero = 1.6;
constexpr std::size_t kMostLegendRows = 14;
constexpr double kRow_px = 22;
/// Of a name that takes two lines.
constexpr double kTwoRows_px = 38;
/// Of the scale of feeds and heights.
constexpr double kScale_px = 190;

/// Axis numbers to the right and up of a view that looks along the third.
struct FlatAxes {
  std::size_t right;
  std::size_t up;
};

constexpr FlatAxes flat_axes_of(PlotView view) {
  switch (view) {
    case PlotView::Front: return {.right = 0, .up = 2};
    case PlotView::Side: return {.right = 1, .up = 2};
    default: return {.right = 0, .up = 1};
  }
}

std::string_view name_of(PlotView view) {
  switch (view) {
    case PlotView::Top: return "Top view";
    case PlotView::Front: return "Front view";
    case PlotView::Side: return "Side view";
    case PlotView::Isometric: break;
  }
  return "Isometric view";
}

void draw_text(Drawing& drawing, Label label) {
  drawing.items.emplace_back(std::move(label));
}

void draw_line(Drawing& drawing, Ink ink, std::initializer_list<Pixel> points) {
  Strokes strokes{.ink = ink, .points = {}, .ends = {}};
  strokes.add(points);
  drawing.items.emplace_back(std::move(strokes));
}

/// Includes the centre unless it goes all around.
Area sector(Pixel center, double radius, double from_deg, double to_deg, Rgb fill) {
  constexpr double kStep_deg = 10;
  Area area{.fill = fill, .corners = {}};
  if (to_deg - from_deg < 360) area.corners.push_back(center);
  for (double angle = from_deg; angle <= to_deg; angle += kStep_deg) {
    const double rad = angle * std::numbers::pi / 180;
    area.corners.push_back({.x = center.x + radius * std::cos(rad), .y = center.y - radius * std::sin(rad)});
  }
  return area;
}

/// The mark for a point that everything is measured from.
void draw_target(Drawing& drawing, Pixel at, double radius) {
  constexpr double kRim = 1.3;
  drawing.items.emplace_back(sector(at, radius + kRim, 0, 360, kText));
  drawing.items.emplace_back(sector(at, radius, 0, 360, 0xFFFFFF));
  drawing.items.emplace_back(sector(at, radius, 0, 90, kText));
  drawing.items.emplace_back(sector(at, radius, 180, 270, kText));
}

double least_of(const PathBounds& bounds, std::size_t axis) {
  return static_cast<double>(bounds.least_mm.at(axis));
}

double most_of(const PathBounds& bounds, std::size_t axis) {
  return static_cast<double>(bounds.most_mm.at(axis));
}

/// Corner `number` of a box: its bits choose the greater X, Y and Z.
Place corner_of(const PathBounds& bounds, unsigned number) {
  Place place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place.at(axis) = (number >> axis & 1U) != 0 ? most_of(bounds, axis) : least_of(bounds, axis);
  }
  return place;
}

/// "39 × 39 × 5.2 mm · Z -3.2 to 2 mm".
std::string sizes_text(const PathBounds& bounds) {
  constexpr std::string_view kTimes = " \xC3\x97 ";
  constexpr std::string_view kDot = " \xC2\xB7 ";
  const bool is_flat = bounds.size_mm(2) <= 0;
  std::string text;
  for (std::size_t axis = 0; axis < (is_flat ? 2 : 3); ++axis) {
    if (axis > 0) text += kTimes;
    text += paper_number(static_cast<double>(bounds.size_mm(axis)));
  }
  text.append(" mm").append(kDot).append("Z ").append(paper_number(least_of(bounds, 2)));
  return is_flat ? text : text + " to " + paper_number(most_of(bounds, 2)) + " mm";
}

/// The words of a name that fit into one line, and the others.
std::pair<std::string, std::string> broken(std::string_view name, double room_px) {
  if (text_width_px(name, 12) <= room_px) return {std::string{name}, {}};
  std::size_t end = 0;
  for (std::size_t at = name.find(' '); at != std::string_view::npos; at = name.find(' ', at + 1)) {
    if (text_width_px(name.substr(0, at), 12) > room_px) break;
    end = at;
  }
  if (end == 0) return {shortened(name, room_px, 12), {}};
  return {std::string{name.substr(0, end)}, std::string{name.substr(end + 1)}};
}

PathBounds shown_part(const PathSummary& path) {
  PathBounds shown = path.bounds;
  shown.include(path.cuts);
  if (shown.is_empty()) shown.include(Point{});
  PathBounds with_zero = shown;
  with_zero.include(Point{});
  bool is_near = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float room = std::max(shown.size_mm(axis), std::max(shown.size_mm(0), shown.size_mm(1)) / 2);
    is_near = is_near && with_zero.size_mm(axis) <= static_cast<float>(kMostOfZero) * room + 1;
  }
  if (is_near) shown = with_zero;
  return shown;
}

}  // namespace

PlotSheet::PlotSheet(const PlotOptions& options, const PathSummary& path, const PathColours& colours)
    : options_(options), path_(path), colours_(colours), shown_(shown_part(path)) {
  const bool is_flat = options.view != PlotView::Isometric;
  const double text = text_px();
  const double pad = options.is_sheet ? kPad_px : 4;
  from_ = {.x = pad + (is_flat ? text * 3.2 : 0), .y = options.is_sheet ? kHeader_px : pad};
  to_ = {.x = options.width_px - pad - (options.is_sheet ? kLegend_px : 0),
         .y = options.height_px - pad - (is_flat ? text * 1.8 : 0)};
  to_ = {.x = std::max(to_.x, from_.x + 40), .y = std::max(to_.y, from_.y + 40)};
  height_px_ = options.height_px;
  projection_.axes = axes_of(options.view);
  fit();
}

double PlotSheet::legend_height_px() const {
  if (!options_.is_sheet) return 0;
  const double rows = std::min(static_cast<double>(colours_.legend().size()), static_cast<double>(kMostLegendRows));
  return colours_.legend().empty() ? kScale_px + 180 : rows * kTwoRows_px + 150;
}

double PlotSheet::text_px() const {
  return options_.is_sheet ? 12 : 11;
}

double PlotSheet::line_px() const {
  return options_.is_sheet ? 1.4 : 1.1;
}

void PlotSheet::fit() {
  projection_.px_per_mm = 1;
  projection_.zero = {};
  Pixel least = projection_.at(corner_of(shown_, 0));
  Pixel most = least;
  for (unsigned number = 1; number < 8; ++number) {
    const Pixel at = projection_.at(corner_of(shown_, number));
    least = {.x = std::min(least.x, at.x), .y = std::min(least.y, at.y)};
    most = {.x = std::max(most.x, at.x), .y = std::max(most.y, at.y)};
  }
  // Sizes and the mark of zero stand outside the path.
  const double rim = options_.view == PlotView::Isometric ? text_px() * 3 : text_px() * 1.6;
  const double width = to_.x - from_.x - 2 * rim;
  const double height = to_.y - from_.y - 2 * rim;
  const double scale = std::min(std::max(width, 10.0) / std::max(most.x - least.x, 1e-3),
                                std::max(height, 10.0) / std::max(most.y - least.y, 1e-3));
  const double needed = std::max({scale * (most.y - least.y) + 2 * rim, legend_height_px(), text_px() * 8});
  if (needed < to_.y - from_.y) {
    height_px_ -= to_.y - from_.y - needed;
    to_.y = from_.y + needed;
  }
  projection_.px_per_mm = scale;
  projection_.zero = {.x = (from_.x + to_.x) / 2 - scale * (least.x + most.x) / 2,
                      .y = (from_.y + to_.y) / 2 - scale * (least.y + most.y) / 2};
}

bool PlotSheet::is_on_paper(Pixel at) const {
  return at.x >= from_.x && at.x <= to_.x && at.y >= from_.y && at.y <= to_.y;
}

void PlotSheet::draw_behind(Drawing& drawing) const {
  if (options_.view == PlotView::Isometric) {
    draw_floor(drawing);
    draw_box(drawing);
  } else {
    draw_grid(drawing);
  }
}

void PlotSheet::draw_before(Drawing& drawing) const {
  if (options_.view == PlotView::Isometric) {
    draw_sizes(drawing);
    draw_axes_from_zero(drawing);
  }
  draw_zero(drawing);
  if (!options_.is_sheet) return;
  draw_header(drawing);
  draw_legend(drawing);
}

void PlotSheet::draw_grid(Drawing& drawing) const {
  const double least_cell_px = options_.is_sheet ? 52 : 36;
  const FlatAxes axes = flat_axes_of(options_.view);
  const double scale = projection_.px_per_mm;
  // The greatest round step may be up to 2.5 times too small: take the least that leaves room for numbers.
  double step = round_step(least_cell_px / scale);
  while (step * scale < least_cell_px) step = round_step(step * 2.51);
  Strokes lines{.ink = {.colour = kGrid, .width_px = 1}, .points = {}, .ends = {}};
  Strokes zero_lines{.ink = {.colour = kZeroLine, .width_px = 1}, .points = {}, .ends = {}};
  std::vector<Label> labels;
  const auto value_at = [&](double pixel, bool across) {
    return across ? (pixel - projection_.zero.x) / scale : (projection_.zero.y - pixel) / scale;
  };
  for (const bool across : {true, false}) {
    const double low = value_at(across ? from_.x : to_.y, across);
    const double high = value_at(across ? to_.x : from_.y, across);
    for (double index = std::ceil(low / step - 1e-9); index * step <= high + 1e-9 * step; ++index) {
      const double value = index * step;
      Strokes& into = index == 0 ? zero_lines : lines;
      if (across) {
        const double x = projection_.zero.x + value * scale;
        into.add({{x, from_.y}, {x, to_.y}});
        labels.push_back({.at = {x, to_.y + text_px() * 1.4}, .text = paper_number(value), .anchor = Anchor::Middle});
      } else {
        const double y = projection_.zero.y - value * scale;
        into.add({{from_.x, y}, {to_.x, y}});
        labels.push_back(
            {.at = {from_.x - 6, y + text_px() * 0.35}, .text = paper_number(value), .anchor = Anchor::End});
      }
    }
  }
  drawing.items.emplace_back(std::move(lines));
  drawing.items.emplace_back(std::move(zero_lines));
  Strokes rim{.ink = {.colour = kBox, .width_px = 1}, .points = {}, .ends = {}};
  rim.add({{from_.x, from_.y}, {to_.x, from_.y}, {to_.x, to_.y}, {from_.x, to_.y}, {from_.x, from_.y}});
  drawing.items.emplace_back(std::move(rim));
  for (Label& label : labels) {
    // The corner is for the axis names.
    const bool is_near_name =
        label.anchor == Anchor::Middle ? label.at.x > to_.x - text_px() * 2.2 : label.at.y < from_.y + text_px() * 2.2;
    if (is_near_name) continue;
    label.size_px = text_px();
    label.colour = kSoftText;
    draw_text(drawing, std::move(label));
  }
  draw_text(drawing, {.at = {to_.x, to_.y + text_px() * 1.4},
                      .text = std::string{kAxisNames[axes.right]},
                      .size_px = text_px() + 1,
                      .colour = kAxisColours.at(axes.right),
                      .anchor = Anchor::End,
                      .bold = true});
  draw_text(drawing, {.at = {from_.x - 6, from_.y + text_px() * 0.8},
                      .text = std::string{kAxisNames[axes.up]},
                      .size_px = text_px() + 1,
                      .colour = kAxisColours.at(axes.up),
                      .anchor = Anchor::End,
                      .bold = true});
}

void PlotSheet::draw_floor(Drawing& drawing) const {
  constexpr double kLeastCell_px = 26;
  constexpr double kMostLines = 400;
  double step = round_step(kLeastCell_px / projection_.px_per_mm);
  while (step * projection_.px_per_mm < kLeastCell_px) step = round_step(step * 2.51);
  Strokes lines{.ink = {.colour = kGrid, .width_px = 1}, .points = {}, .ends = {}};
  const double floor_mm = least_of(shown_, 2);
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
    const std::size_t other = 1 - axis;
    if (most_of(shown_, axis) - least_of(shown_, axis) > kMostLines * step || shown_.size_mm(other) <= 0) continue;
    for (double index = std::ceil(least_of(shown_, axis) / step); index * step <= most_of(shown_, axis); ++index) {
      Place from{0, 0, floor_mm};
      from.at(axis) = index * step;
      Place to = from;
      from.at(other) = least_of(shown_, other);
      to.at(other) = most_of(shown_, other);
      lines.add({projection_.at(from), projection_.at(to)});
    }
  }
  drawing.items.emplace_back(std::move(lines));
}

void PlotSheet::draw_box(Drawing& drawing) const {
  Strokes edges{.ink = {.colour = kBox, .width_px = 1}, .points = {}, .ends = {}};
  const auto corner = [this](unsigned number) { return projection_.at(corner_of(shown_, number)); };
  // The floor, then the two walls behind the path: -X and +Y.
  edges.add({corner(0b000), corner(0b001), corner(0b011), corner(0b010), corner(0b000)});
  edges.add({corner(0b000), corner(0b100), corner(0b110), corner(0b111), corner(0b011)});
  edges.add({corner(0b010), corner(0b110)});
  drawing.items.emplace_back(std::move(edges));
}

void PlotSheet::draw_sizes(Drawing& drawing) const {
  const double size = text_px();
  const auto middle = [this](unsigned from, unsigned to) {
    const Pixel one = projection_.at(corner_of(shown_, from));
    const Pixel other = projection_.at(corner_of(shown_, to));
    return Pixel{.x = (one.x + other.x) / 2, .y = (one.y + other.y) / 2};
  };
  const auto label = [&](Pixel at, std::size_t axis, double turned_deg) {
    if (shown_.size_mm(axis) <= 0) return;
    draw_text(drawing, {.at = at,
                        .text = std::string{kAxisNames[axis]} + "  " +
                                paper_number(static_cast<double>(shown_.size_mm(axis))) + " mm",
                        .size_px = size,
                        .colour = kSoftText,
                        .anchor = Anchor::Middle,
                        .turned_deg = turned_deg});
  };
  const Pixel x = middle(0b000, 0b001);
  const Pixel y = middle(0b001, 0b011);
  const Pixel z = middle(0b011, 0b111);
  label({.x = x.x - size * 0.8, .y = x.y + size * 1.4}, 0, -30);
  label({.x = y.x + size * 0.8, .y = y.y + size * 1.4}, 1, 30);
  if (static_cast<double>(shown_.size_mm(2)) * projection_.px_per_mm > size * 6) {
    label({.x = z.x + size * 1.3, .y = z.y}, 2, 90);
  } else {
    label({.x = z.x + size * 2.8, .y = z.y + size * 0.35}, 2, 0);
  }
}

void PlotSheet::draw_axes_from_zero(Drawing& drawing) const {
  constexpr double kLength_px = 44;
  constexpr double kHead_px = 8;
  if (!is_on_paper(projection_.zero)) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Place along{};
    along.at(axis) = kLength_px / projection_.px_per_mm;
    const Pixel tip = projection_.at(along);
    const Pixel zero = projection_.zero;
    const double length = std::hypot(tip.x - zero.x, tip.y - zero.y);
    const Pixel way{.x = (tip.x - zero.x) / length, .y = (tip.y - zero.y) / length};
    const auto beside = [&](double back, double side) {
      return Pixel{.x = tip.x - way.x * back - way.y * side, .y = tip.y - way.y * back + way.x * side};
    };
    draw_line(drawing, {.colour = kAxisColours.at(axis), .width_px = 2}, {zero, beside(kHead_px, 0)});
    drawing.items.emplace_back(
        Area{.fill = kAxisColours.at(axis),
             .corners = {tip, beside(kHead_px, kHead_px / 2.4), beside(kHead_px, -kHead_px / 2.4)}});
    draw_text(drawing, {.at = {tip.x + way.x * 9, tip.y + way.y * 9 + text_px() * 0.35},
                        .text = std::string{kAxisNames[axis]},
                        .size_px = text_px(),
                        .colour = kAxisColours.at(axis),
                        .anchor = Anchor::Middle,
                        .bold = true});
  }
}

void PlotSheet::draw_zero(Drawing& drawing) const {
  if (is_on_paper(projection_.zero)) draw_target(drawing, projection_.zero, options_.is_sheet ? 6 : 5);
}

void PlotSheet::draw_scale_bar(Drawing& drawing, double y) const {
  constexpr double kMost_px = 150;
  const double x = to_.x + 25;
  // An isometric view shortens all three axes alike.
  const bool is_flat = options_.view != PlotView::Isometric;
  const double px_per_mm = projection_.px_per_mm * (is_flat ? 1 : std::sqrt(2.0 / 3.0));
  const double length_mm = round_step(kMost_px / px_per_mm);
  const double end = x + length_mm * px_per_mm;
  draw_line(drawing, {.colour = kText, .width_px = 1.5}, {{x, y - 5}, {x, y}, {end, y}, {end, y - 5}});
  draw_text(drawing, {.at = {x, y + 17},
                      .text = paper_number(length_mm) + (is_flat ? " mm" : " mm along an axis"),
                      .size_px = 12,
                      .colour = kText});
}

void PlotSheet::draw_header(Drawing& drawing) const {
  constexpr double kTitle_px = 22;
  const double width = options_.width_px - 2 * kPad_px;
  draw_text(drawing, {.at = {kPad_px, 38},
                      .text = shortened(options_.title, width, kTitle_px, true),
                      .size_px = kTitle_px,
                      .colour = kText,
                      .bold = true});
  std::string what{name_of(options_.view)};
  if (!path_.cuts.is_empty()) {
    what += " \xC2\xB7 cuts " + sizes_text(path_.cuts);
  }
  draw_text(drawing, {.at = {kPad_px, 60}, .text = what, .size_px = 13, .colour = kSoftText});
}

void PlotSheet::draw_legend(Drawing& drawing) const {
  const double x = to_.x + 24;
  double y = from_.y + 12;
  draw_text(drawing, {.at = {x, y}, .text = colours_.legend_title(), .size_px = 13, .colour = kText, .bold = true});
  y += 24;
  y = colours_.legend().empty() ? draw_scale(drawing, y) : draw_rows(drawing, y);
  y += 10;
  if (path_.rapid_count > 0) {
    draw_line(drawing, {.colour = kRapid, .width_px = 1.2, .dash = Dash::Dashed}, {{x, y - 4}, {x + 24, y - 4}});
    draw_text(drawing, {.at = {x + 34, y}, .text = "Rapid", .size_px = 12, .colour = kText});
    y += 22;
  }
  if (is_on_paper(projection_.zero)) {
    draw_target(drawing, {.x = x + 12, .y = y - 4}, 5);
    draw_text(drawing, {.at = {x + 34, y}, .text = "Work zero", .size_px = 12, .colour = kText});
    y += 22;
  }
  draw_scale_bar(drawing, y + 8);
}

double PlotSheet::draw_rows(Drawing& drawing, double y) const {
  const double x = to_.x + 24;
  const double room = options_.width_px - kPad_px / 2 - x - 34;
  const auto& rows = colours_.legend();
  const std::size_t shown = rows.size() > kMostLegendRows ? kMostLegendRows - 1 : rows.size();
  for (std::size_t row = 0; row < shown; ++row, y += kRow_px) {
    draw_line(drawing, {.colour = rows[row].colour, .width_px = 3}, {{x + 1, y - 4}, {x + 23, y - 4}});
    const auto [first, rest] = broken(rows[row].name, room);
    draw_text(drawing, {.at = {x + 34, y}, .text = first, .size_px = 12, .colour = kText});
    if (rest.empty()) continue;
    y += kTwoRows_px - kRow_px;
    draw_text(drawing, {.at = {x + 34, y}, .text = shortened(rest, room, 12), .size_px = 12, .colour = kText});
  }
  if (shown == rows.size()) return y;
  draw_text(drawing, {.at = {x + 34, y},
                      .text = "and " + std::to_string(rows.size() - shown) + " more",
                      .size_px = 12,
                      .colour = kSoftText});
  return y + kRow_px;
}

double PlotSheet::draw_scale(Drawing& drawing, double y) const {
  constexpr double kWidth_px = 16;
  constexpr int kTicks = 4;
  const double x = to_.x + 24;
  const Extent& scale = colours_.scale();
  if (scale.size() <= 0) {
    draw_line(drawing, {.colour = colours_.colour(0), .width_px = 3}, {{x + 1, y - 4}, {x + 23, y - 4}});
    draw_text(drawing, {.at = {x + 34, y},
                        .text = scale.is_empty() ? "Cut" : paper_number(scale.most),
                        .size_px = 12,
                        .colour = kText});
    return y + 22;
  }
  const double top = y - 6;
  const auto layers = static_cast<double>(colours_.layers());
  for (std::size_t layer = 0; layer < colours_.layers(); ++layer) {
    const double lower = top + kScale_px * (1 - static_cast<double>(layer) / layers);
    const double upper = top + kScale_px * (1 - static_cast<double>(layer + 1) / layers);
    drawing.items.emplace_back(
        Area{.fill = colours_.colour(layer),
             .corners = {{x, upper}, {x + kWidth_px, upper}, {x + kWidth_px, lower}, {x, lower}}});
  }
  for (int tick = 0; tick <= kTicks; ++tick) {
    const double share = static_cast<double>(tick) / kTicks;
    const double at = top + kScale_px * (1 - share);
    draw_line(drawing, {.colour = kSoftText, .width_px = 1}, {{x + kWidth_px + 2, at}, {x + kWidth_px + 7, at}});
    draw_text(drawing, {.at = {x + kWidth_px + 13, at + 4},
                        .text = paper_number(std::lerp(scale.least, scale.most, share)),
                        .size_px = 12,
                        .colour = kText});
  }
  return top + kScale_px + 30;
}

}  // namespace kerf::rehearsal
