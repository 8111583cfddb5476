// What the three firmwares answer to one line sent after power-up.

#include <gtest/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

using vocabulary::Firmware;

struct AnswerCase {
  const char* line;
  int grbl;
  int rabbit;
  int grblhal;
};

class Answers : public testing::TestWithParam<AnswerCase> {};

TEST_P(Answers, AsTheFirmwareGivesThem) {
  const AnswerCase& row = GetParam();
  EXPECT_EQ(Bench(Firmware::Grbl).send(row.line), row.grbl) << row.line;
  EXPECT_EQ(Bench(Firmware::Rabbit).send(row.line), row.rabbit) << row.line;
  EXPECT_EQ(Bench(Firmware::GrblHal).send(row.line), row.grblhal) << row.line;
}

INSTANTIATE_TEST_SUITE_P(Numbers, Answers,
                         testing::Values(AnswerCase{"G1X1F100", 0, 0, 0}, AnswerCase{"g 1 x 1 f 1 0 0", 0, 0, 0},
                                         AnswerCase{"G1X--1F100", 2, 2, 2}, AnswerCase{"X", 2, 2, 2},
                                         AnswerCase{"G1X1E1F100", 20, 36, 36}, AnswerCase{"G1X1,5F100", 1, 1, 1},
                                         AnswerCase{"G1.005X1F100", 0, 0, 0}, AnswerCase{"G0.999X1", 23, 23, 23},
                                         AnswerCase{"G257X1F100", 23, 23, 20}, AnswerCase{"M259", 23, 23, 20},
                                         AnswerCase{"G16385X1F100", 0, 0, 20}, AnswerCase{"O100", 20, 20, 36},
                                         AnswerCase{"O-1", 20, 20, 4}, AnswerCase{"G-1", 20, 20, 20}));

INSTANTIATE_TEST_SUITE_P(Words, Answers,
                         testing::Values(AnswerCase{"G1X1X2F100", 25, 25, 25}, AnswerCase{"F-1", 4, 4, 4},
                                         AnswerCase{"T256", 38, 38, 0}, AnswerCase{"T1.5", 0, 0, 23},
                                         AnswerCase{"L-1", 36, 36, 23}, AnswerCase{"Q1", 20, 36, 36},
                                         AnswerCase{"D1", 20, 20, 36}, AnswerCase{"N10000001", 27, 27, 27},
                                         AnswerCase{"N-1", 4, 4, 4}, AnswerCase{"P1", 36, 36, 36},
                                         AnswerCase{"G0X1K1", 36, 36, 36}, AnswerCase{"A1", 20, 20, 36},
                                         AnswerCase{"$1", 1, 1, 36}));

INSTANTIATE_TEST_SUITE_P(Groups, Answers,
                         testing::Values(AnswerCase{"G54G55", 21, 21, 21}, AnswerCase{"G0G1X1F1", 24, 21, 24},
                                         AnswerCase{"G28G1X1F1", 24, 0, 24}, AnswerCase{"M3M5", 21, 21, 21},
                                         AnswerCase{"M7M9", 20, 21, 21}, AnswerCase{"G0G80", 21, 21, 21},
                                         AnswerCase{"G92X1G28", 24, 24, 24}, AnswerCase{"G43.1Z1G49", 24, 24, 21},
                                         AnswerCase{"G43.1Z1G0", 24, 0, 24}, AnswerCase{"M6", 20, 0, 0},
                                         AnswerCase{"M62P0", 20, 0, 20}, AnswerCase{"M62P4", 20, 39, 20},
                                         AnswerCase{"M62", 20, 28, 20}, AnswerCase{"M61Q1", 20, 20, 0},
                                         AnswerCase{"M56", 20, 20, 20}));

INSTANTIATE_TEST_SUITE_P(Modes, Answers,
                         testing::Values(AnswerCase{"G1X1", 22, 22, 22}, AnswerCase{"G93G0X1", 0, 22, 0},
                                         AnswerCase{"G95", 20, 20, 20}, AnswerCase{"G43H1", 20, 20, 20},
                                         AnswerCase{"G43.1X1", 37, 37, 0}, AnswerCase{"G43.1", 37, 37, 37},
                                         AnswerCase{"G49.7", 0, 0, 0}, AnswerCase{"G59.1", 23, 23, 0},
                                         AnswerCase{"G59.4", 23, 23, 20}, AnswerCase{"G61", 0, 0, 0},
                                         AnswerCase{"G61.1", 20, 20, 20}, AnswerCase{"G50", 20, 20, 0},
                                         AnswerCase{"G51", 20, 20, 26}, AnswerCase{"G96S1", 20, 20, 20},
                                         AnswerCase{"G53G2X1I1F1", 30, 30, 30}, AnswerCase{"G80X1", 31, 31, 31},
                                         AnswerCase{"G4", 28, 28, 28}, AnswerCase{"G4P-1", 4, 4, 4},
                                         AnswerCase{"G33Z1K1", 20, 20, 20}, AnswerCase{"G66P1", 20, 20, 0},
                                         AnswerCase{"G65P100", 20, 20, 39}, AnswerCase{"M98P100", 20, 20, 39}));

INSTANTIATE_TEST_SUITE_P(Arcs, Answers,
                         testing::Values(AnswerCase{"G2X1Y1F100", 35, 35, 35}, AnswerCase{"G2I1F100", 26, 26, 0},
                                         AnswerCase{"G2Z1I1F100", 32, 32, 0}, AnswerCase{"G2X2.001R1F100", 34, 34, 34},
                                         AnswerCase{"G2X0R1F100", 33, 33, 33}, AnswerCase{"G2X2I1.004F100", 33, 33, 33},
                                         AnswerCase{"G2X2I1.0004F100", 0, 0, 0}, AnswerCase{"G2X2I1P2F100", 36, 36, 0},
                                         AnswerCase{"G2X2I1P0F100", 36, 36, 39}, AnswerCase{"G90.1", 20, 20, 20},
                                         AnswerCase{"G91.1G2X2I1F100", 0, 0, 0}, AnswerCase{"G2X2I1", 22, 22, 22}));

INSTANTIATE_TEST_SUITE_P(Offsets, Answers,
                         testing::Values(AnswerCase{"G10L2P1X1", 0, 0, 0}, AnswerCase{"G10L2P7X1", 29, 29, 0},
                                         AnswerCase{"G10L2P10X1", 29, 29, 29}, AnswerCase{"G10L3P9X1", 29, 20, 20},
                                         AnswerCase{"G10", 26, 26, 20}, AnswerCase{"G10L2P1R1X1", 20, 20, 20},
                                         AnswerCase{"G10L1P1Z1", 20, 20, 20}, AnswerCase{"G92", 26, 26, 26},
                                         AnswerCase{"G92.2", 20, 20, 0}, AnswerCase{"G28.2", 20, 20, 20}));

INSTANTIATE_TEST_SUITE_P(Cycles, Answers,
                         testing::Values(AnswerCase{"G81X1Z-1R1F100", 20, 20, 0}, AnswerCase{"G81", 20, 20, 22},
                                         AnswerCase{"G81X1Z-1F100", 20, 20, 28}, AnswerCase{"G82X1Z-1R1F1", 20, 20, 28},
                                         AnswerCase{"G83X1Z-2R1Q-1F100", 20, 20, 4},
                                         AnswerCase{"G81X1Z1R0F100", 20, 20, 54},
                                         AnswerCase{"G81Z-1R1L0F1", 20, 20, 19},
                                         AnswerCase{"G84X1Z-1R1P1F1", 20, 20, 20}, AnswerCase{"G98", 20, 20, 0}));

INSTANTIATE_TEST_SUITE_P(Comments, Answers,
                         testing::Values(AnswerCase{"(unclosed", 0, 0, 0}, AnswerCase{")", 1, 0, 0},
                                         AnswerCase{"%", 1, 0, 0}, AnswerCase{"%G0", 1, 0, 1},
                                         AnswerCase{"/G0X1", 0, 1, 0}, AnswerCase{"//", 0, 1, 1},
                                         AnswerCase{"G0(x)(y)X1", 0, 0, 0}, AnswerCase{"", 0, 0, 0},
                                         AnswerCase{"G0X1*71", 1, 1, 1}, AnswerCase{"#1=5", 1, 1, 1},
                                         AnswerCase{"G0X[1]", 2, 2, 2}));

}  // namespace
}  // namespace kerf::gcode
