#include "rehearsal/plot.hpp"

#include <array>
#include <cmath>

#include <gmock/gmock.h>

namespace kerf::rehearsal {
namespace {

using testing::HasSubstr;
using testing::Not;
using vocabulary::Firmware;

PathStart start_of_grblhal() {
  simulation::CaseMachine machine{.personality = firmware::personality_of(Firmware::GrblHal)};
  machine.stored.initialised = true;
  return path_start_of(machine);
}

Drawing drawing_of(std::string_view text, PlotOptions options = {}) {
  const auto start = start_of_grblhal();
  return plot(text, start, summarize(text, start), std::array{std::move(options)}).front();
}

constexpr std::string_view kPart =
    "G21 G90\n(Toolpath:- <b>Slot</b>)\nT1 M6\nM3 S1000\nG0 X0 Y0 Z5\nG1 Z-1 F100\nG1 X20\n(Toolpath:- Round)\nT2 M6\n"
    "G0 Z5\nG0 X40 Y10\nG1 Z-2\nG2 X40 Y10 I5 J0 F300\nG0 Z5\nM30\n";

TEST(Plot, SaysWhatItShows) {
  for (const auto view : {PlotView::Top, PlotView::Front, PlotView::Side, PlotView::Isometric}) {
    const std::string svg = to_svg(drawing_of(kPart, {.view = view, .title = "a & b.nc"}));
    for (const auto* words :
         {"a &amp; b.nc", "Operations", "&lt;b&gt;Slot&lt;/b&gt;", "Round", "Rapid", "Work zero", "stroke-dasharray"}) {
      EXPECT_THAT(svg, HasSubstr(words));
    }
    EXPECT_THAT(svg, Not(HasSubstr("<b>")));
  }
}

TEST(Plot, ColoursTellWhatIsAsked) {
  EXPECT_THAT(to_svg(drawing_of(kPart, {.colour = PlotColour::Tool})), HasSubstr(">T2</text>"));
  EXPECT_THAT(to_svg(drawing_of(kPart, {.colour = PlotColour::Feed})), HasSubstr("Feed, mm/min"));
  EXPECT_THAT(to_svg(drawing_of(kPart, {.colour = PlotColour::Height})), HasSubstr("Height (Z), mm"));
}

TEST(Plot, AsMuchAsThePaperHasRoomFor) {
  std::string text = "G21 G90 F1000\nG0 X0 Y0 Z5\nG1 Z0\n";
  for (int row = 0; row < 300; ++row) {
    for (int column = 0; column < 300; ++column) {
      const int x = row % 2 == 0 ? column : 299 - column;
      text += "X" + std::to_string(x) + "Y" + std::to_string(row) + "Z-" + std::to_string((x * 7 + row) % 10) + "\n";
    }
  }
  const std::string svg = to_svg(drawing_of(text, {.width_px = 400, .height_px = 300}));
  EXPECT_LT(svg.size(), 600'000U);
  const std::string small =
      to_svg(drawing_of(text, {.view = PlotView::Top, .colour = PlotColour::Tool, .width_px = 400, .height_px = 300}));
  EXPECT_LT(small.size(), 25'000U) << "straight rows are single lines";
}

TEST(Plot, ALineThatIsDrawnTwiceIsDrawnOnce) {
  std::string text = "G21 G90 F1000\nG0 X0 Y0 Z5\nG1 Z0\n";
  const std::string once = to_svg(drawing_of(text + "X50\nY30\n", {.view = PlotView::Top}));
  for (int time = 0; time < 50; ++time) text += "X50\nY30\nY0\nX0\n";
  const std::string often = to_svg(drawing_of(text, {.view = PlotView::Top}));
  EXPECT_LT(often.size(), once.size() + 100);
}

TEST(Plot, TheFirstCutBelongsToIt) {
  const auto path = summarize("G21 G91\nG1 X10 F100\n", start_of_grblhal());
  EXPECT_EQ(path.cut_count, 1U);
  EXPECT_EQ(path.cuts.most_mm[0], 10);
}

TEST(Plot, EveryProgramHasAPicture) {
  for (const auto* text : {"G0 X0 Y0\n", "(nothing)\n", "G91 G1 X1e9 F1\n", "G21 G90 G1 X0.0001 F100\n", "G28\n"}) {
    for (const auto view : {PlotView::Top, PlotView::Isometric}) {
      const Drawing drawing = drawing_of(text, {.view = view});
      EXPECT_THAT(to_svg(drawing), Not(HasSubstr("nan"))) << text;
      EXPECT_LE(drawing.height_px, 900);
    }
  }
}

TEST(Plot, StepsAreRound) {
  EXPECT_EQ(round_step(7.3), 5);
  EXPECT_EQ(round_step(10), 10);
  EXPECT_EQ(round_step(0.034), 0.02);
  EXPECT_EQ(paper_number(12.50), "12.5");
  EXPECT_EQ(paper_number(0.25), "0.25");
  EXPECT_EQ(paper_number(299.96), "300");
  EXPECT_EQ(paper_number(-0.0001), "0");
}

}  // namespace
}  // namespace kerf::rehearsal
