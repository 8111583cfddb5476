#include "apps/status_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::apps {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

MachineStatus running() {
  MachineStatus status;
  status.machine.state = vocabulary::MachineState::Run;
  status.machine.machine_position_mm = {{1, 2, 3}};
  status.machine.work_position_mm = {{0, 0, 1.5}};
  status.machine.work_coordinate_system = "G55";
  status.machine.feed_mm_per_min = 600;
  status.machine.inputs = machine::Inputs{.limits = "X", .probe = true};
  status.machine.other_fields = {{.name = "THC", .value = "12"}};
  status.link = {.report_age_s = 0.1, .answer_time_s = 0.003, .ask_every_s = 0.05};
  return status;
}

TEST(StatusText, SaysWhatIsKnownByName) {
  const auto lines = status_lines(running());
  EXPECT_THAT(lines.front(), StartsWith("Run: "));
  EXPECT_THAT(lines, Contains("  Work position  X0.000 Y0.000 Z1.500 (G55)"));
  EXPECT_THAT(lines, Contains("  Inputs         X limit, probe"));
  EXPECT_THAT(lines, Contains("  THC            12 (Kerf does not know this field)"));
  EXPECT_THAT(lines, Contains(HasSubstr("asked 20 times a second, answered in 3 ms")));
}

TEST(StatusText, SaysHowOldItIs) {
  MachineStatus status = running();
  EXPECT_EQ(status_line(status, 100), "Run  X0.000 Y0.000 Z1.500  F600  [X limit, probe]");
  status.link.silent_for_s = 2.3;
  EXPECT_THAT(status_line(status, 100), StartsWith("not answering for 2.3 s  Run"));
  EXPECT_EQ(status_line(status, 20).size(), 19U);
}

}  // namespace
}  // namespace kerf::apps
