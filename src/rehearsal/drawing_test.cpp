#include "rehearsal/drawing.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace kerf::rehearsal {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Drawing, TextFromAFileCannotLeaveItsElement) {
  EXPECT_EQ(escape_markup("<b a=\"1\" c='2'>&"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
  EXPECT_EQ(escape_markup("a\x01\x1B\x7F\tb"), "a    b");
  EXPECT_EQ(escape_markup("\xC3\xA9"), "\xC3\xA9");
  EXPECT_EQ(escape_markup("\xE9t"), "\xEF\xBF\xBDt") << "Latin-1 is no UTF-8";
  EXPECT_EQ(escape_markup("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD") << "a surrogate";
}

RC_GTEST_PROP(Drawing, EscapedTextHasNoMarkup, ()) {
  const auto text = *rc::gen::arbitrary<std::string>();
  const std::string escaped = escape_markup(text);
  for (const char letter : escaped) {
    RC_ASSERT(letter != '<' && letter != '>' && letter != '"' && letter != '\'');
    RC_ASSERT(static_cast<unsigned char>(letter) >= ' ');
  }
}

TEST(Drawing, SvgHasLinesAreasAndText) {
  Drawing drawing{.width_px = 100, .height_px = 50, .title = "a<b", .items = {}};
  Strokes strokes{.ink = {.colour = 0x1D5FAA, .width_px = 1.4, .dash = Dash::Dashed}, .points = {}, .ends = {}};
  strokes.add({{1, 2}, {3.04, 1.96}, {3, 10}});
  drawing.items.emplace_back(std::move(strokes));
  drawing.items.emplace_back(Area{.fill = 0xFF, .corners = {{0, 0}, {5, 0}, {5, 5}}});
  drawing.items.emplace_back(Label{.at = {7, 8}, .text = "x&y", .anchor = Anchor::End, .turned_deg = 90});
  const std::string svg = to_svg(drawing);
  EXPECT_THAT(svg, HasSubstr("<title>a&lt;b</title>"));
  EXPECT_THAT(svg, HasSubstr("stroke=\"#1d5faa\" stroke-width=\"1.40\" stroke-dasharray=\"4 3\""));
  EXPECT_THAT(svg, HasSubstr("d=\"M1 2l2 0 0 8\""));
  EXPECT_THAT(svg, HasSubstr("<path fill=\"#0000ff\" d=\"M0 0l5 0 0 5z\"/>"));
  EXPECT_THAT(svg, HasSubstr("text-anchor=\"end\" transform=\"rotate(-90 7 8)\">x&amp;y</text>"));
  EXPECT_THAT(to_svg(drawing, SvgPlace::Inline), Not(HasSubstr("width=\"100\"")));
}

TEST(Drawing, LongTextIsShortenedBetweenLetters) {
  const std::string text = "\xC3\xA9\xC3\xA9\xC3\xA9\xC3\xA9\xC3\xA9\xC3\xA9";
  const std::string cut = shortened(text, 40, 12);
  EXPECT_LT(cut.size(), text.size() + 3);
  EXPECT_TRUE(cut.ends_with("\xE2\x80\xA6"));
  EXPECT_EQ(escape_markup(cut), cut) << "still UTF-8";
  EXPECT_EQ(shortened("short", 400, 12), "short");
}

}  // namespace
}  // namespace kerf::rehearsal
