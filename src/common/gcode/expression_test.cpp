#include "common/gcode/expression.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

struct Read {
  ErrorCode error = ErrorCode::Ok;
  float value = 0.0F;
  int at = 0;
};

Read read(const std::string& text) {
  Parameters parameters;
  parameters.set(1, 2.0F);
  parameters.set(2, 7.0F);
  parameters.set("a", 3.0F);
  ParserState state;
  const Offsets offsets;
  const InterpreterSettings settings;
  const ParameterValues values{.written = parameters, .state = state, .offsets = offsets, .settings = settings};
  ExpressionReader reader(expression_rules(), values, text.c_str());
  Read result;
  std::uint8_t at = 0;
  result.error = reader.read_value(at, result.value);
  result.at = at;
  return result;
}

float value_of(const std::string& text) {
  const Read result = read(text);
  EXPECT_EQ(result.error, ErrorCode::Ok) << text;
  EXPECT_EQ(result.at, static_cast<int>(text.size())) << text;
  return result.value;
}

TEST(Expression, OperatorsBindAsInTheTable) {
  EXPECT_EQ(value_of("[1+2*3]"), 7.0F);
  EXPECT_EQ(value_of("[2*3**2]"), 18.0F);
  EXPECT_EQ(value_of("[2**3**2]"), 64.0F) << "from the left";
  EXPECT_EQ(value_of("[5-2-1]"), 2.0F);
  EXPECT_EQ(value_of("[1+1EQ2AND3GT2]"), 1.0F);
  EXPECT_EQ(value_of("[-7MOD3]"), 2.0F) << "never negative";
  EXPECT_EQ(value_of("[1OR0XOR1]"), 0.0F);
  EXPECT_EQ(value_of("[1EQ1.00009]"), 1.0F) << "close enough";
}

TEST(Expression, SignsParametersAndFunctions) {
  EXPECT_EQ(value_of("--1"), 1.0F);
  EXPECT_EQ(value_of("-[1+2]"), -3.0F);
  EXPECT_EQ(value_of("-#1"), -2.0F);
  EXPECT_EQ(value_of("##1"), 7.0F);
  EXPECT_EQ(value_of("#[#1]"), 7.0F);
  EXPECT_EQ(value_of("#<A>"), 3.0F);
  EXPECT_EQ(value_of("#4711"), 0.0F);
  EXPECT_EQ(value_of("ATAN[1]/[1]"), 45.0F);
  EXPECT_EQ(value_of("SQRT[16]"), 4.0F);
  EXPECT_EQ(value_of("ROUND[-2.5]"), -3.0F);
  EXPECT_EQ(value_of("FIX[-2.5]"), -3.0F);
  EXPECT_EQ(value_of("FUP[2.1]"), 3.0F);
  EXPECT_EQ(value_of("EXISTS[#<a>]"), 1.0F);
  EXPECT_EQ(value_of("EXISTS[#<b>]"), 0.0F);
  EXPECT_NEAR(value_of("SIN[30]"), 0.5F, 1e-6F);
}

TEST(Expression, EveryFaultHasItsNumber) {
  const auto error_of = [](const std::string& text) { return static_cast<int>(read(text).error); };
  EXPECT_EQ(error_of(""), 75);
  EXPECT_EQ(error_of("[2+"), 75);
  EXPECT_EQ(error_of("[2"), 71);
  EXPECT_EQ(error_of("[2^3]"), 71);
  EXPECT_EQ(error_of("FOO[1]"), 71);
  EXPECT_EQ(error_of("SIN1"), 75);
  EXPECT_EQ(error_of("[1/0]"), 72);
  EXPECT_EQ(error_of("[1/0+"), 72) << "divided before the end is seen";
  EXPECT_EQ(error_of("ACOS[2]"), 73);
  EXPECT_EQ(error_of("LN[0]"), 73);
  EXPECT_EQ(error_of("[-2**0.5]"), 74);
  EXPECT_EQ(error_of("ATAN[1]"), 75);
  EXPECT_EQ(error_of("EXISTS[#1]"), 75);
  EXPECT_EQ(error_of("EXP[1000]"), 76);
  EXPECT_EQ(error_of("[1MOD0]"), 76);
  EXPECT_EQ(error_of("#9999"), 39);
  EXPECT_EQ(error_of("#-1"), 39);
  EXPECT_EQ(error_of("#1.5"), 23);
  EXPECT_EQ(error_of("#<none>"), 2);
  EXPECT_EQ(error_of("#<" + std::string(32, 'x') + ">"), 81);
  EXPECT_EQ(error_of("-"), 2);
}

RC_GTEST_PROP(ExpressionProperty, SumsAndProductsAreFloats, ()) {
  const int a = *rc::gen::inRange(-999, 999);
  const int b = *rc::gen::inRange(-999, 999);
  const int c = *rc::gen::inRange(1, 99);
  const std::string text = "[" + std::to_string(a) + "+" + std::to_string(b) + "*" + std::to_string(c) + "]";
  RC_ASSERT(value_of(text) == static_cast<float>(a) + static_cast<float>(b) * static_cast<float>(c));
}

RC_GTEST_PROP(ExpressionProperty, BracketsChangeNothing, ()) {
  const float number = static_cast<float>(*rc::gen::inRange(-9999, 9999)) / 8.0F;
  std::string text;
  append_number(NumberPrinter::RoundThenSplit, number, 3, text);
  const int depth = *rc::gen::inRange(0, 40);
  const std::string nested =
      std::string(static_cast<std::size_t>(depth), '[') + text + std::string(static_cast<std::size_t>(depth), ']');
  RC_ASSERT(value_of(nested) == number);
}

RC_GTEST_PROP(ExpressionProperty, AnyTextIsSurvived, (const std::string& text)) {
  static_cast<void>(read(text.substr(0, 255)));
}

}  // namespace
}  // namespace kerf::gcode
