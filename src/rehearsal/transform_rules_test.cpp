// What becomes of each kind of line, and what is refused.

#include <gmock/gmock.h>

#include "rehearsal/line_text.hpp"
#include "rehearsal/number_text.hpp"
#include "rehearsal/transform.hpp"

namespace kerf::rehearsal {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using vocabulary::Firmware;

std::string transformed(std::string program, const std::vector<TransformStep>& steps,
                        Firmware firmware = Firmware::GrblHal) {
  const auto loaded = *job::Program::load("part.nc", std::move(program));
  const auto text = transformed_text(*loaded, steps, vocabulary::dialect_of(firmware));
  return text ? *text : "refused, line " + std::to_string(text.error().line) + ": " + text.error().reason;
}

const std::vector<TransformStep> kMoved{Translate{10, 20, 0.5}};
const std::vector<TransformStep> kTurned{Rotate{45}};
const std::vector<TransformStep> kQuarter{Rotate{90}};

TEST(NumberText, IsAsShortAsItsTolerance) {
  EXPECT_EQ(number_text(7.0710678, 6e-6), "7.07107");
  EXPECT_EQ(number_text(9.9999999, 6e-6), "10");
  EXPECT_EQ(number_text(-0.0000001, 6e-6), "0");
  EXPECT_EQ(length_text(10.123456, 1.0), "10.123456");
  EXPECT_EQ(length_text(1234.56789012, 1.0), "1234.5679") << "firmware reads eight digits";
}

TEST(LineText, KnowsWhereItsWordsStand) {
  LineText line("n10 (X9) g 1 x+1 .5Y-2;Z3");
  ASSERT_EQ(line.words().size(), 4U);
  EXPECT_EQ(line.find('X')->value, 1.5);
  EXPECT_FALSE(line.has('Z'));
  line.replace(*line.find('X'), "X7");
  EXPECT_EQ(line.text(), "n10 (X9) g 1 X7Y-2;Z3");
}

TEST(TransformRules, WhatIsNotChangedStaysByteForByte) {
  const std::string program =
      "%\r\n(caf\xE9)\r\nN10  G21 G90\r\n\r\nN20 G0\tX1.500 y2 ; away\r\nN30 Z 5 (up)\rN40 M3S1000\nG1 F100 Z-1";
  EXPECT_EQ(transformed(program, {Translate{}}), program);
  EXPECT_EQ(transformed(program, {Translate{1, 0, 0}}),
            "%\r\n(caf\xE9)\r\nN10  G21 G90\r\n\r\nN20 G0\tX2.5 y2 ; away\r\nN30 Z 5 (up)\rN40 M3S1000\nG1 F100 Z-1");
}

TEST(TransformRules, TheMachinesOwnPlacesStay) {
  EXPECT_EQ(transformed("G90 G53 G0 Z0\nG0 X1 Y1\nG0 Z5\nG28 G91 Z0\n", kMoved),
            "G90 G53 G0 Z0\nG0 X11 Y21\nG0 Z5.5\nG28 G91 Z0\n");
  EXPECT_EQ(transformed("G0 X1 Y1 Z5\nG28 X2 Y2\n", kQuarter), "G0 X-1 Y1 Z5\nG28 X-2 Y2\n");
  EXPECT_THAT(transformed("G0 X1 Y1 Z5\nG28 X2\n", kQuarter), StartsWith("refused, line 2: This cannot be rotated"));
}

TEST(TransformRules, ANameOfAKnownPlaceIsMappedAndOfAnUnknownOneStays) {
  EXPECT_EQ(transformed("G0 X1 Y1 Z5\nG92 X0 Y0\nG1 X5 F100\n", kMoved), "G0 X11 Y21 Z5.5\nG92 X10 Y20\nG1 X15 F100\n");
  EXPECT_EQ(transformed("G92 X0 Y0 Z0\nG0 X1 Y1 Z5\n", kMoved), "G92 X0 Y0 Z0\nG0 X11 Y21 Z5.5\n");
  EXPECT_EQ(transformed("G0 X1 Y1 Z5\nG38.2 Z-5 F50\nG10 L20 P1 Z0\nG0 Z2\n", kMoved),
            "G0 X11 Y21 Z5.5\nG38.2 Z-4.5 F50\nG10 L20 P1 Z0\nG0 Z2.5\n");
  EXPECT_EQ(transformed("G0 X3 Y4\nG92 X0\nG0 X1\n", kQuarter), "G0 X-4 Y3\nG92 Y0\nG0 Y1\n");
}

TEST(TransformRules, ZerosAndToolsStay) {
  EXPECT_EQ(transformed("G10 L2 P2 X-100 Y-50\nG55 G0 X1 Y1\nG43.1 Z-3\nG0 Z5\n", kMoved),
            "G10 L2 P2 X-100 Y-50\nG55 G0 X11 Y21\nG43.1 Z-3\nG0 Z5.5\n");
  EXPECT_EQ(transformed("G43 H1 Z15\n", kMoved), "G43 H1 Z15.5\n");
}

TEST(TransformRules, OneAxisOfATurnedJobNeedsTheOther) {
  EXPECT_THAT(transformed("G0 X1\n", kTurned),
              StartsWith("refused, line 1: This cannot be rotated: it names X, and no line "
                         "has said where Y is."));
  EXPECT_THAT(transformed("G0 X1 Y1\nG55\nG0 X2\n", kTurned), StartsWith("refused, line 3"));
  EXPECT_EQ(transformed("G0 X10 Y0\nX0\n", {Rotate{45}}), "G0 X7.07107 Y7.07107\nX0 Y0\n");
  EXPECT_EQ(transformed("G0X10\n", kQuarter), "G0Y10\n");
}

TEST(TransformRules, IncrementsAreMappedOrRefused) {
  EXPECT_EQ(transformed("G0 X1 Y1 Z1\nG91 G1 X5 F100\n", kMoved), "G0 X11 Y21 Z1.5\nG91 G1 X5 F100\n");
  EXPECT_THAT(transformed("G91 G1 X5 F100\n", kMoved), StartsWith("refused, line 1: This cannot be translated: it cuts "
                                                                  "along X"));
  EXPECT_EQ(transformed("G91 G1 X5 Y1 F100\nX0.001 Y0\n", {Rotate{180}}), "G91 G1 X-5 Y-1 F100\nX-0.001 Y0\n");
}

TEST(TransformRules, ACutAtAnUnknownPlaceIsRefused) {
  EXPECT_THAT(transformed("G1 X5 F100\n", kMoved), HasSubstr("where Y is"));
  EXPECT_EQ(transformed("G1 X5 F100\n", {Translate{1, 0, 0}}), "G1 X6 F100\n");
}

TEST(TransformRules, MirroredArcsTurnTheOtherWay) {
  EXPECT_EQ(transformed("G0 X0 Y0\nG02 X10 Y0 I5 J1 F100\nX20 Y0 I5 J1\nG1 X0\n", {Mirror{MirrorAxis::X, 0}}),
            "G0 X0 Y0\nG03 X-10 Y0 I-5 J1 F100\nX-20 Y0 I-5 J1\nG1 X0\n");
  EXPECT_EQ(transformed("G0 X0 Y0 Z0\nG2 X10 Y0 R8 F100\nG18 X20 Z0 R8\n", {Mirror{MirrorAxis::Y, 0}}),
            "G0 X0 Y0 Z0\nG3 X10 Y0 R8 F100\nG2 G18 X20 Z0 R8\n");
  EXPECT_THAT(transformed("G0 X0 Y0 Z5\nG38.2 Z-5 F50\n", {Mirror{MirrorAxis::Z, 0}}), StartsWith("refused, line 2"));
}

TEST(TransformRules, AnArcOfHalfATurnGetsItsCentre) {
  EXPECT_EQ(transformed("G0 X0 Y0\nG2 X20 Y0 R10 F100\n", {Translate{0.1, 0.1, 0}}),
            "G0 X0.1 Y0.1\nG2 X20.1 Y0.1 I10 J0 F100\n");
}

TEST(TransformRules, ArcsThatBecomeNoneAreRefused) {
  EXPECT_THAT(transformed("G0 X0 Y0\nG2 X2 Y2 I2 J0 F100\n", {Scale{2, 1, 1}}), HasSubstr("--arcs-to-lines"));
  EXPECT_THAT(transformed("G18\nG0 X0 Y0 Z0\nG2 X2 Z2 I2 K0 F100\n", kTurned), StartsWith("refused, line 3"));
  EXPECT_THAT(transformed("G0 X0 Y0\nG2 X2 Y2 I2 J0 F100\n", {ArcsToLines{0.01}, Scale{2, 1, 1}}),
              HasSubstr("X4 Y2\n"));
}

TEST(TransformRules, CyclesKeepTheirShape) {
  EXPECT_EQ(transformed("G0 X0 Y0 Z5\nG83 X1 Y2 Z-3 R1 Q0.5 F100\nX3\nG80\n", kMoved),
            "G0 X10 Y20 Z5.5\nG83 X11 Y22 Z-2.5 R1.5 Q0.5 F100\nX13\nG80\n");
  EXPECT_EQ(transformed("G0 X0 Y0 Z5\nG83 X1 Y2 Z-3 R1 Q0.5 F100\nG80\n", {Scale{2, 2, 2}}),
            "G0 X0 Y0 Z10\nG83 X2 Y4 Z-6 R2 Q1 F100\nG80\n");
  EXPECT_THAT(transformed("G0 Z5\nG81 X1 Y2 Z-3 R1 F100\n", {Mirror{MirrorAxis::Z, 0}}), StartsWith("refused, line 2"));
}

TEST(TransformRules, TheOtherUnit) {
  EXPECT_EQ(transformed("G21 G90\nG0 X25.4 Z5\nG1 Z-1 F254\nG4 P1\n", {ConvertUnits{LengthUnit::Inch}}),
            "G20 G90\nG0 X1 Z0.19685\nG1 Z-0.03937 F10\nG4 P1\n");
  EXPECT_EQ(transformed("G0 X25.4\n", {ConvertUnits{LengthUnit::Inch}}), "G20\nG0 X1\n");
  EXPECT_EQ(transformed("G20\nG93 G1 X1 F2\nG94 G1 X2 F2\n", {ConvertUnits{LengthUnit::Mm}}),
            "G21\nG93 G1 X25.4 F2\nG94 G1 X50.8 F50.8\n");
}

TEST(TransformRules, FewerDecimalsDoNotAddUp) {
  EXPECT_EQ(transformed("G91\nG1 X0.333 F100.0\nX0.333\nX0.333\n", {TrimDecimals{1}}),
            "G91\nG1 X0.3 F100\nX0.4\nX0.3\n");
  EXPECT_EQ(transformed("G0 X10.000 Y.500\n", {TrimDecimals{3}}), "G0 X10 Y0.5\n");
}

TEST(TransformRules, CommentsFeedsAndSpeeds) {
  EXPECT_EQ(transformed("(a)\nG1 X1 (b) F100 ; c\n(MSG, hello)\n\nM3 S1000\n",
                        {StripComments{}, ScaleFeed{50}, ScaleSpeed{110}}),
            "G1 X1  F50\n(MSG, hello)\n\nM3 S1100\n");
  EXPECT_EQ(transformed("G1 X1 F100\n(MSG, hello)\n", {StripComments{}}, Firmware::Grbl), "G1 X1 F100\n");
}

TEST(TransformRules, WhatOnlyTheControllerKnowsIsRefused) {
  EXPECT_THAT(transformed("G0 X1\nG1 X#1 F100\n", kMoved), StartsWith("refused, line 2"));
  EXPECT_THAT(transformed("G65 P1 X1\n", kMoved), StartsWith("refused, line 1"));
  EXPECT_THAT(transformed("G0 X1 Y1\n/G0 X2\n", kMoved), StartsWith("refused, line 2"));
  EXPECT_THAT(transformed("G81 X1 Y1 Z-1 R1 F1\n", kMoved, Firmware::Grbl),
              HasSubstr("Grbl refuses this line with error:20"));
  EXPECT_THAT(transformed("$J=G91X1F100\nG0 X1\n", kMoved), StartsWith("refused, line 1"));
}

TEST(TransformRules, NothingBehindTheEndIsTouched) {
  EXPECT_EQ(transformed("G0 X1 Y1 Z1\nM30\nG0 X1 anything\n%\n", kMoved), "G0 X11 Y21 Z1.5\nM30\nG0 X1 anything\n%\n");
}

}  // namespace
}  // namespace kerf::rehearsal
