#include "sender/session/tool_work.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::session {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;
using vocabulary::MachineState;

machine::Snapshot at(std::vector<double> machine_mm, std::vector<double> offset_mm, MachineState state) {
  machine::Snapshot snapshot;
  snapshot.state = state;
  snapshot.machine_position_mm = machine_mm;
  snapshot.work_offset_mm = offset_mm;
  for (std::size_t axis = 0; axis < machine_mm.size(); ++axis) machine_mm[axis] -= offset_mm[axis];
  snapshot.work_position_mm = machine_mm;
  return snapshot;
}

ToolWork after_work_from(const machine::Snapshot& start) {
  ToolWork work;
  work.begin(start);
  static_cast<void>(work.on_line(Instant{}, start));
  work.on_answer();
  work.on_report();
  work.on_report();
  return work;
}

TEST(ToolWork, TakesWhatLeavesTheModesAlone) {
  for (const auto* line :
       {"$J=G91 X5 F500", "G10 L20 P0 Z0", "g10l2p1x-1.5", "G43.1Z-2.1", "G49", "$TPW", "$tlr", "$#"}) {
    EXPECT_THAT(ToolWork::why_not(line), IsEmpty()) << line;
  }
  for (const auto* line :
       {"G0X1", "G38.2Z-10F50", "G10L20P0Z0G0X1", "G43.1Z1F100", "M3", "$H", "$110=5", "G92Z0", "T3", ""}) {
    EXPECT_FALSE(ToolWork::why_not(line).empty()) << line;
  }
}

TEST(ToolWork, TellsAControllerInItsToolStateOnceThatLinesCome) {
  ToolWork work;
  const auto snapshot = at({0, 0, 0}, {0, 0, 0}, MachineState::Tool);
  work.begin(snapshot);
  EXPECT_TRUE(work.on_line(Instant{1s}, snapshot));
  EXPECT_TRUE(work.must_wait());
  work.advance_to(Instant{1200ms});
  EXPECT_TRUE(work.must_wait());
  work.advance_to(work.next_deadline());
  EXPECT_FALSE(work.must_wait());
  EXPECT_EQ(work.next_deadline(), kNever);
  EXPECT_FALSE(work.on_line(Instant{2s}, snapshot));
}

TEST(ToolWork, GoesBackUpAlongAndDownLast) {
  const auto work = after_work_from(at({10, 20, -5}, {0, 0, -10}, MachineState::Idle));
  // The new tool is 3 mm longer.
  EXPECT_THAT(work.way_back(at({0, 20, -30}, {0, 0, -7}, MachineState::Idle)),
              Optional(ElementsAre("$J=G21G90G53Z-2.000F1000", "$J=G21G90G53X10.000F1000")));
  EXPECT_THAT(work.way_back(at({0, 0, 0}, {0, 0, -10}, MachineState::Idle)),
              Optional(ElementsAre("$J=G21G90G53X10.000Y20.000F1000", "$J=G21G90G53Z-5.000F1000")));
  EXPECT_THAT(work.way_back(at({10, 20, -5}, {0, 0, -10}, MachineState::Idle)), Optional(IsEmpty()));
}

TEST(ToolWork, WaitsForTheReportOfANewOffset) {
  auto work = after_work_from(at({10, 20, -5}, {0, 0, -10}, MachineState::Idle));
  work.on_answer();
  work.on_report();
  EXPECT_FALSE(work.way_back(at({10, 20, -5}, {0, 0, -10}, MachineState::Idle)));
}

}  // namespace
}  // namespace kerf::session
