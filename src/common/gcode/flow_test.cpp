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

/// A program that is read from a file: its places are its lines.
void run_file(Bench& bench, const std::vector<const char*>& lines) {
  constexpr int kEnough = 1000;
  std::uint64_t at = 0;
  for (int read = 0; at < lines.size() && read < kEnough; ++read) {
    const char* const line = lines.at(at);
    bench.interpreter.settings().file_position = ++at;
    EXPECT_EQ(bench.send(line), 0) << line;
    if (const auto jump = bench.interpreter.take_file_jump()) at = jump->position;
  }
  EXPECT_EQ(at, lines.size());
}

TEST(Flow, LoopsGoBackInTheirFile) {
  Bench bench(expression_rules());
  run_file(bench, {"o1 while [#1 lt 3]", "#1=[#1+1]", "(print,w#1)", "o1 endwhile", "o2 do", "#1=[#1-1]", "(print,d#1)",
                   "o2 while [#1 gt 1]", "o3 repeat [2]", "(print,r)", "o3 endrepeat", "o4 repeat [0]", "(print,no)",
                   "o4 endrepeat", "o5 while [0]", "(print,no)", "o5 endwhile"});
  EXPECT_EQ(said(bench), (std::vector<std::string>{"w1.000", "w2.000", "w3.000", "d2.000", "d1.000", "r", "r"}));
}

TEST(Flow, RoundsAndLoopsAreLeft) {
  Bench bench(expression_rules());
  run_file(bench,
           {"o4 repeat [5]", "#2=[#2+1]", "o5 if [#2 eq 2]", "o4 continue", "o5 endif", "(print,#2)", "o6 if [#2 ge 3]",
            "o4 break", "o6 endif", "o4 endrepeat", "o7 do", "o7 break", "o7 while [1]", "(print,end)"});
  EXPECT_EQ(said(bench), (std::vector<std::string>{"1.000", "3.000", "end"}));
}

TEST(Flow, SubroutinesHaveValuesAndGiveOneBack) {
  Bench bench(expression_rules());
  run_file(bench,
           {"o100 sub", "(print,in #1 #2)", "o101 if [#1 eq 9]", "o100 return [#1*2]", "o101 endif", "o100 endsub [#2]",
            "#1=5 #2=6", "o100 call [7]", "(print,out #1 #<_value>)", "o100 call [9] [1]", "(print,out #1 #<_value>)"});
  EXPECT_EQ(said(bench),
            (std::vector<std::string>{"in 7.000 6.000", "out 5.000 6.000", "in 9.000 1.000", "out 5.000 10.000"}));
}

TEST(Flow, CallsWithinCallsAreLimited) {
  Bench bench(expression_rules());
  bench.interpreter.settings().file_position = 1;
  EXPECT_EQ(bench.send("o1 sub"), 0);
  EXPECT_EQ(bench.send("o1 endsub"), 0);
  for (int depth = 0; depth < 10; ++depth) EXPECT_EQ(bench.send("o1 call"), 0) << depth;
  EXPECT_EQ(bench.send("o1 call"), 82);
  EXPECT_EQ(bench.send("o1 call"), 81) << "the error has forgotten the subroutine";
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
