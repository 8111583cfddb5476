// The only file that knows Cairo.

#include "apps/drawing_png.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <variant>

#include <cairo.h>

namespace kerf::apps {
namespace {

using rehearsal::Anchor;
using rehearsal::Area;
using rehearsal::Drawing;
using rehearsal::Label;
using rehearsal::Strokes;

/// Lines that are no more than an upright or level grid are drawn on the pixels themselves.
constexpr double kMiddleOfPixel = 0.5;

struct SurfaceCloser {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct PenCloser {
  void operator()(cairo_t* pen) const { cairo_destroy(pen); }
};

void set_colour(cairo_t* pen, rehearsal::Rgb colour) {
  constexpr double kFull = 255;
  const auto part = [colour](unsigned shift) { return static_cast<double>((colour >> shift) & 0xFFU) / kFull; };
  cairo_set_source_rgb(pen, part(16), part(8), part(0));
}

void draw(cairo_t* pen, const Strokes& strokes) {
  set_colour(pen, strokes.ink.colour);
  cairo_set_line_width(pen, strokes.ink.width_px);
  const bool is_dashed = strokes.ink.dash == rehearsal::Dash::Dashed;
  constexpr std::array<double, 2> kDashes{4, 3};
  cairo_set_dash(pen, kDashes.data(), is_dashed ? static_cast<int>(kDashes.size()) : 0, 0);
  cairo_set_line_cap(pen, is_dashed ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
  std::size_t from = 0;
  for (const std::size_t end : strokes.ends) {
    const bool is_grid =
        end - from == 2 && strokes.ink.width_px == 1 &&
        (strokes.points[from].x == strokes.points[from + 1].x || strokes.points[from].y == strokes.points[from + 1].y);
    for (std::size_t at = from; at < end; ++at) {
      const auto snapped = [is_grid](double value) { return is_grid ? std::floor(value) + kMiddleOfPixel : value; };
      cairo_line_to(pen, snapped(strokes.points[at].x), snapped(strokes.points[at].y));
    }
    // Line by line: one long path takes much longer.
    cairo_stroke(pen);
    from = end;
  }
}

void draw(cairo_t* pen, const Area& area) {
  set_colour(pen, area.fill);
  for (const auto& corner : area.corners) cairo_line_to(pen, corner.x, corner.y);
  cairo_close_path(pen);
  cairo_fill(pen);
}

void draw(cairo_t* pen, const Label& label) {
  constexpr double kHalfTurn_deg = 180;
  set_colour(pen, label.colour);
  cairo_select_font_face(pen, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         label.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(pen, label.size_px);
  cairo_text_extents_t extents{};
  cairo_text_extents(pen, label.text.c_str(), &extents);
  cairo_save(pen);
  cairo_translate(pen, label.at.x, label.at.y);
  cairo_rotate(pen, -label.turned_deg * std::numbers::pi / kHalfTurn_deg);
  const double share = label.anchor == Anchor::Start ? 0 : label.anchor == Anchor::Middle ? kMiddleOfPixel : 1;
  cairo_move_to(pen, -extents.x_advance * share, 0);
  cairo_show_text(pen, label.text.c_str());
  cairo_restore(pen);
  cairo_new_path(pen);
}

cairo_status_t append(void* out, const unsigned char* bytes, unsigned length) {
  static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(bytes), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::optional<std::string> to_png(const Drawing& drawing) {
  const std::unique_ptr<cairo_surface_t, SurfaceCloser> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(drawing.width_px)),
                                 static_cast<int>(std::lround(drawing.height_px))));
  const std::unique_ptr<cairo_t, PenCloser> pen(cairo_create(surface.get()));
  cairo_set_source_rgb(pen.get(), 1, 1, 1);
  cairo_paint(pen.get());
  cairo_set_line_join(pen.get(), CAIRO_LINE_JOIN_ROUND);
  for (const auto& item : drawing.items) {
    std::visit([&](const auto& part) { draw(pen.get(), part); }, item);
  }
  std::string png;
  if (cairo_status(pen.get()) != CAIRO_STATUS_SUCCESS) return std::nullopt;
  if (cairo_surface_write_to_png_stream(surface.get(), append, &png) != CAIRO_STATUS_SUCCESS) return std::nullopt;
  return png;
}

}  // namespace kerf::apps
