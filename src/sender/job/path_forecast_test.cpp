#include "sender/job/path_forecast.hpp"

#include <gtest/gtest.h>

#include "common/gcode/rules.hpp"

namespace kerf::job {
namespace {

using vocabulary::Firmware;

PathRules rules_of(Firmware firmware) {
  PathRules rules{.motion = motion::rules_of(firmware), .planner_blocks = 15};
  rules.settings.axes = 3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rules.settings.steps_per_mm.at(axis) = 250;
    rules.settings.max_rate_mm_per_min.at(axis) = 3000;
  }
  return rules;
}

class Forecast : public testing::Test {
 protected:
  void begin(Firmware firmware = Firmware::Grbl) {
    forecast_.begin(gcode::Interpreter{gcode::rules_for(firmware)}, {}, rules_of(firmware));
  }
  void send(std::string_view text) { forecast_.on_sent(++line_, text); }

  PathForecast forecast_;
  std::uint32_t line_ = 0;
};

TEST_F(Forecast, KnowsPlaceLineAndLeastTimeOfEachPiece) {
  begin();
  send("G1X10F600");
  send("G4P1");
  send("G0Y30");
  const auto& pieces = forecast_.pieces();
  ASSERT_EQ(pieces.size(), 4U);
  EXPECT_EQ(pieces[1].file_line, 1U);
  EXPECT_FLOAT_EQ(pieces[1].end_mm[0], 10);
  EXPECT_FLOAT_EQ(pieces[1].feed_mm_per_min, 600);
  // 10 mm/s, and twice as fast at 200 %.
  EXPECT_NEAR(pieces[1].least_s, 0.5, 0.02);
  EXPECT_EQ(pieces[2].file_line, 2U);
  EXPECT_EQ(pieces[2].least_s, 0);
  EXPECT_TRUE(pieces[3].rapid);
  EXPECT_NEAR(pieces[3].least_s, 0.6, 0.02);
  EXPECT_NEAR(pieces[3].reached_s, 0.5, 0.02);
}

TEST_F(Forecast, CutsArcsLikeTheFirmware) {
  begin();
  send("G2X0Y0I10J0F1000");
  EXPECT_GT(forecast_.pieces().size(), 100U);
  for (const PathPiece& piece : forecast_.pieces()) EXPECT_LE(std::abs(piece.end_mm[1]), 10.001F);
}

TEST_F(Forecast, AllowsAHoleToBeDrilledOnceMore) {
  begin(Firmware::GrblHal);
  send("G0Z5");
  send("G98G81X10Z-2R1F600");
  const auto& pieces = forecast_.pieces();
  // Rest, up, across, down to R, stroke, back, and those two again.
  ASSERT_EQ(pieces.size(), 8U);
  EXPECT_FLOAT_EQ(pieces[4].end_mm[2], -2);
  EXPECT_GT(pieces[4].least_s, 0);
  EXPECT_FLOAT_EQ(pieces[6].end_mm[2], -2);
  EXPECT_FLOAT_EQ(pieces[7].end_mm[2], 5);
  EXPECT_EQ(pieces[6].least_s + pieces[7].least_s, 0);
  EXPECT_EQ(pieces[7].blocks, pieces[5].blocks);
}

TEST_F(Forecast, OpensAtWhatItCannotFollow) {
  for (const std::string_view text : {"#1=5", "G1X[1+2]F100", "$H", "$100=80", "O100 CALL", "G1X1X2"}) {
    begin();
    send("G1X10F600");
    send(text);
    send("X20");
    EXPECT_TRUE(forecast_.is_open()) << text;
    EXPECT_EQ(forecast_.pieces().size(), 2U) << text;
    EXPECT_FALSE(forecast_.open_reason().empty());
  }
  begin();
  send("$G");
  send("(MSG,#1 is [fine])");
  EXPECT_FALSE(forecast_.is_open()) << forecast_.open_reason();
}

TEST_F(Forecast, DoubtsTheProbedAxisUntilItsPlaceIsSaid) {
  begin();
  send("G38.2Z-10F50");
  send("G0X5");
  send("G91G0Z2");
  send("G90G0Z5");
  const auto& pieces = forecast_.pieces();
  ASSERT_EQ(pieces.size(), 5U);
  EXPECT_EQ(pieces[1].unknown_axes, 0U);
  EXPECT_EQ(pieces[1].least_s, 0) << "it may touch at once";
  EXPECT_EQ(pieces[2].unknown_axes, 4U);
  EXPECT_EQ(pieces[3].unknown_axes, 4U);
  EXPECT_EQ(pieces[4].unknown_axes, 4U) << "it begins somewhere";
  send("G0X7");
  EXPECT_EQ(forecast_.pieces().back().unknown_axes, 0U);
}

TEST_F(Forecast, DoubtsEveryAxisAndTheToolLengthBehindAToolChange) {
  begin(Firmware::GrblHal);
  send("T2M6");
  send("G0X5");
  send("G0Y5");
  send("G0X6");
  ASSERT_FALSE(forecast_.is_open()) << forecast_.open_reason();
  EXPECT_EQ(forecast_.pieces().back().unknown_axes, 4U);
}

TEST_F(Forecast, KnowsThePlaceAgainOnceTheMachineRestsBehindAToolChange) {
  begin(Firmware::GrblHal);
  send("G1X10F600");
  send("T2M6");
  EXPECT_FALSE(forecast_.seeks_place()) << "not answered yet";
  forecast_.on_acknowledged();
  forecast_.on_acknowledged();
  ASSERT_TRUE(forecast_.seeks_place());
  // Measured 2.5 mm longer, and left elsewhere.
  ASSERT_TRUE(forecast_.stand({10, 0, 30}, {0, 0, 2.5F}));
  EXPECT_FALSE(forecast_.seeks_place());
  ASSERT_EQ(forecast_.pieces().size(), 1U);
  EXPECT_FLOAT_EQ(forecast_.pieces()[0].end_mm[2], 30);
  send("G3X0Z-1I-5J0");
  ASSERT_FALSE(forecast_.is_open()) << forecast_.open_reason();
  EXPECT_NEAR(forecast_.pieces().back().end_mm[2], 1.5, 1e-4);
  EXPECT_EQ(forecast_.pieces().back().unknown_axes, 0U);
  send("G49");
  send("G0Z0");
  EXPECT_FLOAT_EQ(forecast_.pieces().back().end_mm[2], 0);
}

TEST_F(Forecast, OpensWhenOffsetsMayHaveBeenSetByHand) {
  begin();
  forecast_.on_work_by_hand("$#");
  EXPECT_FALSE(forecast_.is_open());
  forecast_.on_work_by_hand("G10L20P1Z0");
  EXPECT_TRUE(forecast_.is_open());
}

TEST_F(Forecast, CountsWhatIsSurelyOver) {
  begin();
  for (int i = 1; i <= 40; ++i) send("G1X" + std::to_string(i) + "F600");
  EXPECT_EQ(forecast_.surely_over(), 0U);
  for (int i = 1; i <= 40; ++i) forecast_.on_acknowledged();
  // 15 blocks wait, one is executing, and prepared segments may be of 5 more.
  EXPECT_EQ(forecast_.surely_over(), 1U + 40U - 21U);
  send("M5");
  send("M3S500");
  forecast_.on_acknowledged();
  forecast_.on_acknowledged();
  EXPECT_EQ(forecast_.surely_over(), 41U) << "the spindle waits for the motion";
  EXPECT_EQ(forecast_.line_acknowledged(), 42U);
}

}  // namespace
}  // namespace kerf::job
