#include "common/gcode/parameters.hpp"

#include <gtest/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

TEST(Parameters, CallsHaveTheirOwn) {
  Parameters parameters;
  parameters.set(1, 5.0F);
  parameters.set(31, 6.0F);
  parameters.set("local", 7.0F);
  parameters.set("_global", 8.0F);
  ASSERT_TRUE(parameters.begin_call(1));
  EXPECT_EQ(parameters.get(1), 0.0F);
  EXPECT_EQ(parameters.get(31), 6.0F);
  EXPECT_FALSE(parameters.get("local"));
  EXPECT_EQ(parameters.get("_global"), 8.0F);
  parameters.set(1, 9.0F);
  parameters.end_call();
  EXPECT_EQ(parameters.get(1), 5.0F);
  ASSERT_TRUE(parameters.begin_call(1));
  EXPECT_EQ(parameters.get(1), 0.0F) << "gone with its call";
}

TEST(Parameters, CallsEndSomewhere) {
  Parameters parameters;
  for (std::size_t level = 0; level < Parameters::kDeepestCall; ++level)
    EXPECT_TRUE(parameters.begin_call(static_cast<int>(level) + 1));
  EXPECT_FALSE(parameters.begin_call(99));
}

TEST(Parameters, NamesAreCleaned) {
  EXPECT_EQ(clean_name("A b"), "ab");
  EXPECT_EQ(clean_name("_"), std::nullopt);
  EXPECT_EQ(clean_name(" "), std::nullopt);
  EXPECT_EQ(clean_name(std::string(40, 'x')), std::string(31, 'x'));
}

TEST(Assignment, NumbersWaitForTheEndOfTheBlockNamesDoNot) {
  Bench bench(expression_rules());
  EXPECT_EQ(bench.send("#1=5"), 0);
  EXPECT_EQ(bench.send("#1=6 #2=#1"), 0);
  EXPECT_EQ(bench.interpreter.parameter(2), 5.0F);
  EXPECT_EQ(bench.send("#3=1 #3=2"), 0);
  EXPECT_EQ(bench.interpreter.parameter(3), 1.0F) << "the first one comes last";
  EXPECT_EQ(bench.send("#<n>=4 #1=#<n>"), 0);
  EXPECT_EQ(bench.interpreter.parameter(1), 4.0F);
  EXPECT_EQ(bench.send("#1=9 #<n>=9 G1 X1"), 22);
  EXPECT_EQ(bench.interpreter.parameter(1), 4.0F) << "a failed block assigns no numbers";
  EXPECT_EQ(bench.interpreter.parameter("n"), 9.0F);
}

TEST(Assignment, WhatIsWritable) {
  Bench bench(expression_rules());
  EXPECT_EQ(bench.send("#0=1"), 39);
  EXPECT_EQ(bench.send("#5060=1"), 0);
  EXPECT_EQ(bench.send("#5061=1"), 39);
  EXPECT_EQ(bench.send("#<_x>=7"), 0) << "accepted without effect";
  EXPECT_EQ(bench.interpreter.parameter("_x"), 0.0F);
  EXPECT_EQ(bench.send("#1 5"), 2);
  std::string many;
  for (int i = 1; i <= 11; ++i) many += "#" + std::to_string(i) + "=1";
  EXPECT_EQ(bench.send(many), 2);
}

TEST(ParameterValues, TellTheInterpretersState) {
  Bench bench(expression_rules());
  EXPECT_EQ(bench.send("G10L2P2X5"), 0);
  EXPECT_EQ(bench.send("G55G91G20F10S500M3"), 0);
  const auto told = [&](std::string_view name) { return bench.interpreter.parameter(name).value_or(-99.0F); };
  EXPECT_EQ(bench.interpreter.parameter(5220), 2.0F);
  EXPECT_EQ(bench.interpreter.parameter(5241), 5.0F);
  EXPECT_EQ(bench.interpreter.parameter(5231), std::nullopt);
  EXPECT_EQ(told("_coord_system"), 550.0F);
  EXPECT_EQ(told("_incremental"), 1.0F);
  EXPECT_EQ(told("_metric"), 0.0F);
  EXPECT_EQ(told("_rpm"), 500.0F);
  EXPECT_EQ(told("_x"), -5.0F);
  EXPECT_EQ(told("_nothing"), -99.0F);
}

TEST(Macros, GetTheirWordsAsParameters) {
  Bench bench(expression_rules());
  EXPECT_EQ(bench.send("G65P3I100Q5"), 0);
  EXPECT_EQ(bench.interpreter.parameter(100), 5.0F);
  EXPECT_EQ(bench.send("G65P3I100"), 0);
  EXPECT_EQ(bench.interpreter.parameter("_value"), 5.0F);
  EXPECT_EQ(bench.send("G65P3I100S31"), 0);
  EXPECT_EQ(bench.interpreter.parameter(31), 5.0F);
  EXPECT_EQ(bench.send("G65P3I6000Q1"), 39);
  EXPECT_EQ(bench.send("G65P3"), 28);
  EXPECT_EQ(bench.interpreter.parameter("_call_level"), 0.0F);
}

}  // namespace
}  // namespace kerf::gcode
