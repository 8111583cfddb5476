#include "io/sleep_inhibitor.hpp"

#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::io {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

TEST(SleepInhibitor, SaysOnceThatNobodyGrantsIt) {
  ::setenv("DBUS_SYSTEM_BUS_ADDRESS", "unix:path=/nonexistent/bus", 1);
  EventLoop loop;
  std::vector<std::string> said;
  const SleepInhibitor inhibitor(loop, "A job runs", [&](const std::string& sentence) {
    said.push_back(sentence);
    loop.stop();
  });
  loop.run();
  ::unsetenv("DBUS_SYSTEM_BUS_ADDRESS");
  ASSERT_THAT(said, SizeIs(1));
  EXPECT_THAT(said[0], HasSubstr("Nobody keeps this computer awake"));
}

TEST(SleepInhibitor, MayEndBeforeItIsAnswered) {
  ::setenv("DBUS_SYSTEM_BUS_ADDRESS", "unix:path=/nonexistent/bus", 1);
  for (int round = 0; round < 50; ++round) {
    EventLoop loop;
    const SleepInhibitor inhibitor(loop, "A job runs", [](const std::string&) {});
  }
  ::unsetenv("DBUS_SYSTEM_BUS_ADDRESS");
}

}  // namespace
}  // namespace kerf::io
