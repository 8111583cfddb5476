// Three hours at the machine in a few seconds, twice, with the same bytes.

#include <chrono>

#include <gtest/gtest.h>

#include "scenario.hpp"
#include "simulation/long_job.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using vocabulary::Firmware;

class ThreeHours : public testing::TestWithParam<Firmware> {};
INSTANTIATE_TEST_SUITE_P(Firmwares, ThreeHours, testing::ValuesIn(kFirmwares),
                         [](const auto& param) { return word_for(param.param); });

TEST_P(ThreeHours, PassTwiceWithTheSameBytes) {
  const auto part = program(long_job(3));
  World first{quick_serial(GetParam())};
  World second{quick_serial(GetParam())};
  for (World* const world : {&first, &second}) {
    const auto job = run_job(*world, part, 6h);
    ASSERT_TRUE(job);
    EXPECT_EQ(job->phase, job::JobPhase::Finished) << job->reason;
    EXPECT_GE(job->progress.elapsed_s, 3 * 3600.0);
    EXPECT_LE(world->most_bytes_in_flight(), world->session().window_bytes());
  }
  EXPECT_TRUE(first.transcript() == second.transcript());
  EXPECT_EQ(first.now(), second.now());
}

}  // namespace
}  // namespace kerf::scenarios
