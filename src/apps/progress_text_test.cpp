#include "apps/progress_text.hpp"

#include <gtest/gtest.h>

namespace kerf::apps {
namespace {

machine::Snapshot running() {
  machine::Snapshot snapshot;
  snapshot.state = vocabulary::MachineState::Run;
  snapshot.work_position_mm = {12.3454, -0.0001, 0.5};
  snapshot.feed_mm_per_min = 1200;
  return snapshot;
}

job::JobState half_done() {
  job::JobState job;
  job.progress.lines_total = 1930;
  job.progress.file_line = 812;
  job.progress.percent = 42.9;
  job.progress.elapsed_s = 72.9;
  job.progress.remaining_s = 3700;
  return job;
}

TEST(ProgressText, Clock) {
  EXPECT_EQ(clock_text(0), "0:00");
  EXPECT_EQ(clock_text(245.9), "4:05");
  EXPECT_EQ(clock_text(3729), "1:02:09");
  EXPECT_EQ(clock_text(-1), "0:00");
}

TEST(ProgressText, PositionHasNoMinusZero) {
  EXPECT_EQ(position_text(running()), "X12.345 Y0.000 Z0.500");
}

TEST(ProgressText, LineForALog) {
  EXPECT_EQ(progress_line(half_done(), running()),
            " 42 %  line 812/1930  1:12 gone, 1:01:40 left  F1200  X12.345 Y0.000 Z0.500  Run");
  job::JobState begun = half_done();
  begun.progress.remaining_s.reset();
  EXPECT_NE(progress_line(begun, running()).find("-:-- left"), std::string::npos);
}

TEST(ProgressText, BarGivesUpTheLeastImportantFirst) {
  EXPECT_EQ(progress_bar(half_done(), 80, false),
            "##############..................   42 %  line 812/1930  1:12 gone, 1:01:40 left");
  EXPECT_EQ(progress_bar(half_done(), 50, true), " 42 %  line 812/1930  1:12 gone, 1:01:40 left");
  EXPECT_EQ(progress_bar(half_done(), 40, false), " 42 %  1:12 gone, 1:01:40 left");
  EXPECT_EQ(progress_bar(half_done(), 12, false), " 42 %");
  EXPECT_EQ(machine_line(running(), 80), "Run  F1200  X12.345 Y0.000 Z0.500");
  for (int columns = 2; columns < 200; ++columns) {
    EXPECT_LT(progress_bar(half_done(), columns, false).size(), static_cast<std::size_t>(columns));
    EXPECT_LT(machine_line(running(), columns).size(), static_cast<std::size_t>(columns));
  }
}

}  // namespace
}  // namespace kerf::apps
