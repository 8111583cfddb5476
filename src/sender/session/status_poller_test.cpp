#include "sender/session/status_poller.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace kerf::session {
namespace {

using namespace std::chrono_literals;

TEST(StatusPoller, ThePaceFollowsTheLink) {
  EXPECT_EQ(poll_periods({}).moving, 50ms);
  EXPECT_EQ(poll_periods({}).resting, 100ms);
  EXPECT_EQ(poll_periods({.baud = 115200}).moving, 100ms);
  EXPECT_EQ(poll_periods({.baud = 115200}).resting, 200ms);
  EXPECT_EQ(poll_periods({.baud = 1000000}).moving, 50ms);
  EXPECT_GT(poll_periods({.baud = 9600}).moving, 200ms);
}

TEST(StatusPoller, ASlowLinkIsNotAskedTwiceBeforeItAnswers) {
  StatusPoller poller;
  Instant now{};
  poller.start(now, poll_periods({}));
  poller.on_asked(now);
  now += 400ms;
  EXPECT_FALSE(poller.is_due(now));
  (void)poller.on_report(now, {});
  EXPECT_TRUE(poller.is_due(now));
  EXPECT_NEAR(*poller.health(now).answer_time_s, 0.4, 1e-9);
}

TEST(StatusPoller, SilenceIsToldOnceAndMeasuredAllTheTime) {
  StatusPoller poller;
  Instant now{};
  poller.start(now, poll_periods({}));
  poller.on_asked(now);
  EXPECT_FALSE(poller.take_silence(now + 1900ms));
  EXPECT_TRUE(poller.take_silence(now + 2300ms));
  EXPECT_FALSE(poller.take_silence(now + 3s));
  EXPECT_NEAR(*poller.health(now + 4500ms).silent_for_s, 4.5, 1e-9);
  EXPECT_TRUE(poller.on_report(now + 5s, {}));
  EXPECT_FALSE(poller.health(now + 5s).silent_for_s);
}

TEST(StatusPoller, AutomaticReportsThatStopAreAskedFor) {
  StatusPoller poller;
  Instant now{};
  poller.start(now, poll_periods({}));
  poller.on_asked(now);
  (void)poller.on_report(now, {.automatic = 200ms});
  EXPECT_FALSE(poller.is_due(now + 700ms));
  EXPECT_TRUE(poller.is_due(now + 900ms));
  EXPECT_TRUE(poller.health(now).automatic);
}

}  // namespace
}  // namespace kerf::session
