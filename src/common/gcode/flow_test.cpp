#include "common/gcode/flow.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/gcode/interpreter_bench.hpp"

namespace kerf::gcode {
namespace {

std::vector<std::string> said(const Bench& bench) {
  std::vector<std::string> texts;
  for (const auto& message : bench.all<OperatorMessage>()) texts.push_back(message.text);
  return texts;
}

void run(Bench& bench, std::initializer_list<const char*> lines) {
  for (const char* line : lines) EXPECT_EQ(bench.send(line), 0) << line;
}

TEST(Flow, OneBranchIsTaken) {
  Bench bench(expression_rules());
  run(bench, {"o1 if [0]", "(print,if)", "o1 elseif [1]", "(print,elseif)", "o1 elseif [1]", "(print,again)", "o1 else",
              "(print,else)", "o1 endif", "(print,after)"});
  EXPECT_EQ(said(bench), (std::vector<std::string>{"elseif", "after"}));
}

TEST(Flow, BranchesNest) {
  Bench bench(expression_rules());
  run(bench, {"o1 if [0]", "o2 if [1]", "(print,a)", "o2 else", "(print,b)", "o2 endif", "o1 else", "o<in> if [1]",
              "(print,c)", "o<in> endif", "o1 endif"});
  EXPECT_EQ(said(bench), (std::vector<std::string>{"c"}));
}

TEST(Flow, PassedOverLinesAreStillRead) {
  Bench bench(expression_rules());
  run(bench, {"o1 if [0]", "G1 Y1", "#1=[1/0]", "N5 G0 X[1/0]"});
  EXPECT_EQ(bench.send("X[1/0]"), 72) << "the first word has to be readable";
}

TEST(Flow, LoopsWantAFile) {
  Bench bench(expression_rules());
  for (const char* line : {"o1 while [1]", "o1 do", "o1 repeat [2]", "o1 sub", "o1 call", "o1 return", "o1 break"})
    EXPECT_EQ(bench.send(line), 80) << line;
  EXPECT_EQ(bench.send("o<name> call"), 84);
  EXPECT_EQ(bench.send("o1 endif"), 81);
  EXPECT_EQ(bench.send("o1 nonsense"), 81);
  EXPECT_EQ(bench.send("o1 if 1"), 20);
  EXPECT_EQ(bench.send("o<> if [1]"), 83);
}

TEST(Flow, ErrorsAndAlarmsOnDemand) {
  Bench bench(expression_rules());
  EXPECT_EQ(bench.send("o1 error [5]"), 5);
  EXPECT_EQ(bench.send("o1 error [0]"), 0);
  EXPECT_EQ(bench.send("o1 alarm [3]"), 0);
  ASSERT_EQ(bench.all<AlarmRequest>().size(), 1U);
  EXPECT_EQ(bench.all<AlarmRequest>().front().code, 3);
}

TEST(Flow, AResetForgetsBranches) {
  Bench bench(expression_rules());
  EXPECT_EQ(bench.send("o1 if [0]"), 0);
  bench.interpreter.reset();
  EXPECT_EQ(bench.send("(print,seen)"), 0);
  EXPECT_EQ(said(bench), (std::vector<std::string>{"seen"}));
}

TEST(Print, FormatsAndWhatCannotBeRead) {
  Bench bench(expression_rules());
  run(bench, {"#1=5.5", "#<foo>=3", "(print, v #1 %d#1 %.1f#1 %f#<Foo>)", "(PRINT,#[1+1] #9999 #<x> #[1 + 1])",
              "(print,100%)", "(print,#1 %d)", "(debug,#1)", "(msg, raw #1)"});
  EXPECT_EQ(said(bench),
            (std::vector<std::string>{"v 5.500 6 5.5 3.000", "0.000 N/A N/A N/A+ 1]", "00", "6 ", "raw #1"}));
}

TEST(Print, DebugNeedsItsSetting) {
  Bench bench(expression_rules(), {.prints_debug = true});
  run(bench, {"(debug,on)"});
  EXPECT_EQ(said(bench), (std::vector<std::string>{"on"}));
}

TEST(Print, AbortIsAnError) {
  Bench bench(expression_rules());
  EXPECT_EQ(bench.send("(abort,no tool)"), 253);
  EXPECT_EQ(said(bench), (std::vector<std::string>{"Error: no tool"}));
}

TEST(Print, OtherBuildsKnowNothingOfIt) {
  Bench bench(vocabulary::Firmware::GrblHal);
  run(bench, {"(print,a)", "(abort,b)"});
  EXPECT_TRUE(said(bench).empty());
}

/// Only the lines of taken branches speak, however branches are nested.
RC_GTEST_PROP(FlowProperty, BranchesSelectLines, ()) {
  Bench bench(expression_rules());
  std::vector<std::string> expected;
  const int depth = *rc::gen::inRange(1, 10);
  bool is_taken = true;
  for (int level = 0; level < depth; ++level) {
    const bool condition = *rc::gen::arbitrary<bool>();
    is_taken = is_taken && condition;
    const std::string name = std::to_string(level + 1);
    RC_ASSERT(bench.send("o" + name + " if [" + (condition ? "1" : "0") + "]") == 0);
    RC_ASSERT(bench.send("(print," + name + ")") == 0);
    if (is_taken) expected.push_back(name);
  }
  for (int level = depth; level > 0; --level) RC_ASSERT(bench.send("o" + std::to_string(level) + " endif") == 0);
  RC_ASSERT(bench.send("(print,end)") == 0);
  expected.emplace_back("end");
  RC_ASSERT(said(bench) == expected);
}

}  // namespace
}  // namespace kerf::gcode
