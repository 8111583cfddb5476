#include "sender/machine/startup_line.hpp"

#include <gtest/gtest.h>

namespace kerf::machine {
namespace {

TEST(StartupLine, IsKnownByItsId) {
  EXPECT_TRUE(is_startup_line("N0"));
  EXPECT_TRUE(is_startup_line("n1"));
  EXPECT_FALSE(is_startup_line("110"));
  EXPECT_FALSE(is_startup_line("Network/N0"));
}

TEST(StartupLine, ModesDoNothing) {
  for (const char* line :
       {"", "G20 G54 G17", "g21g90(units)", "G10L2P1X5", "G92 X0 Y0", "M5 M9", "F500 S1000", "G43.1Z5"}) {
    EXPECT_EQ(deed_of_startup_line(line), "") << line;
  }
}

TEST(StartupLine, WhatMovesIsCalledOut) {
  EXPECT_EQ(deed_of_startup_line("G54 g0 x10"), "moves the axes");
  EXPECT_EQ(deed_of_startup_line("G28"), "moves the axes");
  EXPECT_EQ(deed_of_startup_line("G21|X10"), "moves the axes");
  EXPECT_EQ(deed_of_startup_line("M3S1000"), "starts the spindle");
  EXPECT_EQ(deed_of_startup_line("T1 M6"), "asks for a tool change");
  EXPECT_EQ(deed_of_startup_line("G1X#5"), "may move the axes");
  EXPECT_EQ(deed_of_startup_line("$H"), "may move the axes");
}

}  // namespace
}  // namespace kerf::machine
