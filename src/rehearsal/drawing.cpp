#include "rehearsal/drawing.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

constexpr std::string_view kEllipsis = "\xE2\x80\xA6";
constexpr std::string_view kReplacement = "\xEF\xBF\xBD";
constexpr std::string_view kFonts = "system-ui,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif";

/// Bytes of the UTF-8 letter that `text` begins with; 0 if it begins with none.
std::size_t letter_length(std::string_view text) {
  const auto byte = [text](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) return 0;
  for (std::size_t at = 1; at < length; ++at) {
    if ((byte(at) & 0xC0U) != 0x80U) return 0;
  }
  // Overlong forms, surrogates and what lies behind the last letter.
  if (byte(0) == 0xE0 && byte(1) < 0xA0) return 0;
  if (byte(0) == 0xED && byte(1) > 0x9F) return 0;
  if (byte(0) == 0xF0 && byte(1) < 0x90) return 0;
  if (byte(0) == 0xF4 && byte(1) > 0x8F) return 0;
  // U+FFFE and U+FFFF are no letters of XML.
  if (byte(0) == 0xEF && byte(1) == 0xBF && byte(2) >= 0xBE) return 0;
  return length;
}

/// Share of the font's size.
double letter_width(std::string_view letter) {
  if (letter.size() > 1) return letter.size() > 2 ? 0.9 : 0.58;
  constexpr std::string_view kNarrow = "iljtfI.,:;'|!()[]{} /-";
  constexpr std::string_view kWide = "mwMW@%";
  if (kNarrow.contains(letter)) return 0.34;
  if (kWide.contains(letter)) return 0.9;
  return letter[0] >= 'A' && letter[0] <= 'Z' ? 0.68 : 0.58;
}

/// In tenths of a pixel: no screen shows more.
void append_tenths(std::string& out, std::int64_t tenths) {
  if (tenths < 0) out += '-';
  const std::int64_t whole = std::abs(tenths);
  if (whole >= 10 || whole == 0) out += std::to_string(whole / 10);
  if (whole % 10 != 0) (out += '.') += static_cast<char>('0' + whole % 10);
}

void append_pixels(std::string& out, double value) {
  append_tenths(out, std::llround(value * 10));
}

void append_colour(std::string& out, Rgb colour) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += '#';
  for (int shift = 20; shift >= 0; shift -= 4) out += kHex[(colour >> static_cast<unsigned>(shift)) & 0xFU];
}

/// Absolute where a line begins, then steps from point to point, rounded so that errors do not add up.
void append_points(std::string& out, const Pixel* begin, const Pixel* end) {
  std::int64_t x = std::llround(begin->x * 10);
  std::int64_t y = std::llround(begin->y * 10);
  const auto pair = [&out](std::int64_t first, std::int64_t second) {
    append_tenths(out, first);
    if (second >= 0) out += ' ';
    append_tenths(out, second);
  };
  out += 'M';
  pair(x, y);
  bool is_first = true;
  for (const Pixel* point = begin + 1; point != end; ++point) {
    const std::int64_t to_x = std::llround(point->x * 10);
    const std::int64_t to_y = std::llround(point->y * 10);
    if (to_x == x && to_y == y && end - begin > 2) continue;
    if (is_first) out += 'l';
    if (!is_first && to_x - x >= 0) out += ' ';
    pair(to_x - x, to_y - y);
    is_first = false;
    x = to_x;
    y = to_y;
  }
}

void append_strokes(std::string& out, const Strokes& strokes) {
  if (strokes.ends.empty()) return;
  out += "<path fill=\"none\" stroke=\"";
  append_colour(out, strokes.ink.colour);
  out += "\" stroke-width=\"" + base::to_fixed(strokes.ink.width_px, 2);
  out += strokes.ink.dash == Dash::Dashed ? "\" stroke-dasharray=\"4 3" : "\" stroke-linecap=\"round";
  out += "\" stroke-linejoin=\"round\" d=\"";
  std::size_t from = 0;
  for (const std::size_t end : strokes.ends) {
    if (end > from) append_points(out, strokes.points.data() + from, strokes.points.data() + end);
    from = end;
  }
  out += "\"/>\n";
}

void append_area(std::string& out, const Area& area) {
  if (area.corners.empty()) return;
  out += "<path fill=\"";
  append_colour(out, area.fill);
  out += "\" d=\"";
  append_points(out, area.corners.data(), area.corners.data() + area.corners.size());
  out += "z\"/>\n";
}

void append_label(std::string& out, const Label& label) {
  out += "<text x=\"";
  append_pixels(out, label.at.x);
  out += "\" y=\"";
  append_pixels(out, label.at.y);
  out += "\" font-size=\"";
  append_pixels(out, label.size_px);
  out += "\" fill=\"";
  append_colour(out, label.colour);
  if (label.anchor != Anchor::Start) {
    out += label.anchor == Anchor::Middle ? "\" text-anchor=\"middle" : "\" text-anchor=\"end";
  }
  if (label.bold) out += "\" font-weight=\"600";
  if (label.turned_deg != 0) {
    out += "\" transform=\"rotate(";
    append_pixels(out, -label.turned_deg);
    out += ' ';
    append_pixels(out, label.at.x);
    out += ' ';
    append_pixels(out, label.at.y);
    out += ')';
  }
  out += "\">" + escape_markup(label.text) + "</text>\n";
}

}  // namespace

double text_width_px(std::string_view text, double size_px, bool bold) {
  double width = 0;
  while (!text.empty()) {
    const std::size_t length = std::max(letter_length(text), std::size_t{1});
    width += letter_width(text.substr(0, length));
    text.remove_prefix(length);
  }
  constexpr double kBolder = 1.07;
  return width * size_px * (bold ? kBolder : 1);
}

std::string shortened(std::string_view text, double width_px, double size_px, bool bold) {
  if (text_width_px(text, size_px, bold) <= width_px) return std::string{text};
  std::string kept;
  while (!text.empty()) {
    const std::size_t length = std::max(letter_length(text), std::size_t{1});
    const std::string longer = kept + std::string{text.substr(0, length)};
    if (text_width_px(longer, size_px, bold) + size_px > width_px) break;
    kept = longer;
    text.remove_prefix(length);
  }
  while (kept.ends_with(' ')) kept.pop_back();
  return kept + std::string{kEllipsis};
}

std::string escape_markup(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = letter_length(text);
    const char first = text[0];
    const auto byte = static_cast<unsigned char>(first);
    if (length == 0) {
      out += kReplacement;
    } else if (first == '&') {
      out += "&amp;";
    } else if (first == '<') {
      out += "&lt;";
    } else if (first == '>') {
      out += "&gt;";
    } else if (first == '"') {
      out += "&quot;";
    } else if (first == '\'') {
      out += "&#39;";
    } else if (byte < ' ' || byte == 0x7F) {
      out += ' ';
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max(length, std::size_t{1}));
  }
  return out;
}

std::string to_svg(const Drawing& drawing, SvgPlace place) {
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ";
  append_pixels(out, drawing.width_px);
  out += ' ';
  append_pixels(out, drawing.height_px);
  if (place == SvgPlace::File) {
    out += "\" width=\"";
    append_pixels(out, drawing.width_px);
    out += "\" height=\"";
    append_pixels(out, drawing.height_px);
  }
  out += "\" font-family=\"" + std::string{kFonts};
  if (drawing.title.empty()) {
    out += "\" aria-hidden=\"true\">\n";
  } else {
    out += "\" role=\"img\">\n<title>" + escape_markup(drawing.title) + "</title>\n";
  }
  if (place == SvgPlace::File) out += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (const DrawingItem& item : drawing.items) {
    std::visit(base::Overloaded{[&](const Strokes& strokes) { append_strokes(out, strokes); },
                                [&](const Area& area) { append_area(out, area); },
                                [&](const Label& label) { append_label(out, label); }},
               item);
  }
  return out + "</svg>\n";
}

}  // namespace kerf::rehearsal
