#include "firmware/stored_state.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

StoredState sample() {
  StoredState state;
  state.initialised = true;
  state.settings = {{"110", "600.000"}, {"Homing/Enable", "1"}};
  state.offsets = {{"G54", {1.0, -2.5, 3.0}}, {"G92", {0.0, 0.0, 0.125}}};
  state.tools = {{3, {.length_mm = {0.0, 0.0, 12.5}, .radius_mm = 0.5}}};
  state.startup_lines = {"G54G21", ""};
  state.user_text = "mill = left";
  return state;
}

TEST(StoredState, PrintsAndReadsTheSame) {
  const auto read = parse_stored_state(print(sample()));
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, sample());
}

TEST(StoredState, EmptyTextIsABlankMemory) {
  EXPECT_EQ(print(StoredState{}), "");
  EXPECT_EQ(parse_stored_state(""), StoredState{});
  EXPECT_FALSE(parse_stored_state("\n")->initialised);
}

TEST(StoredState, SaysWhereATextIsWrong) {
  using Reason = StoredStateError::Reason;
  EXPECT_EQ(parse_stored_state("$1=2\n").error(), (StoredStateError{Reason::NotAState, 1}));
  EXPECT_EQ(parse_stored_state("# kerf state 1\nG0X1\n").error(), (StoredStateError{Reason::UnknownLine, 2}));
  EXPECT_EQ(parse_stored_state("# kerf state 1\n\n[G54:1,x,2]\n").error(), (StoredStateError{Reason::BadNumber, 3}));
  EXPECT_EQ(parse_stored_state("# kerf state 1\n[G99:1]\n").error(), (StoredStateError{Reason::UnknownLine, 2}));
}

TEST(StoredState, SettingsFileTakesOnlySettings) {
  StoredState state;
  ASSERT_TRUE(apply_settings_text(state, "# my mill\r\n$110=3000\r\n\r\n; more\n $Homing/Enable=1\n$N0=G20\n"));
  EXPECT_TRUE(state.initialised);
  EXPECT_EQ(state.settings.at("110"), "3000");
  EXPECT_EQ(state.settings.at("Homing/Enable"), "1");
  EXPECT_EQ(state.startup_lines.at(0), "G20");

  const StoredState before = state;
  const auto refused = apply_settings_text(state, "$111=1\n$I=mill\n");
  EXPECT_EQ(refused.error(), (StoredStateError{StoredStateError::Reason::NotASetting, 2}));
  EXPECT_EQ(state, before);
}

}  // namespace
}  // namespace kerf::firmware
