#include "io/usb_policy.hpp"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::io {
namespace {

using testing::HasSubstr;

SerialPort port(std::string vendor, std::string product) {
  SerialPort port;
  port.path = "/dev/ttyUSB0";
  port.vendor = std::move(vendor);
  port.product = std::move(product);
  return port;
}

TEST(UsbPolicy, AnUnoRestartsOnlyWhenItsDtrWasDown) {
  const auto uno = port("2341", "0043");
  EXPECT_TRUE(opening_of(uno, true).may_restart);
  EXPECT_THAT(opening_of(uno, true).sentence, HasSubstr("restarts the controller"));
  EXPECT_FALSE(opening_of(uno, false).may_restart);
  EXPECT_THAT(opening_of(uno, false).sentence, HasSubstr("not restarted"));
}

TEST(UsbPolicy, EveryKindIsToldApart) {
  EXPECT_EQ(policy_for(port("1a86", "7523")).lines, ControlLines::Depends);
  EXPECT_EQ(policy_for(port("10c4", "ea60")).lines, ControlLines::EitherAlone);
  EXPECT_EQ(policy_for(port("0483", "5740")).lines, ControlLines::DtrTalks);
  EXPECT_EQ(policy_for(port("2341", "8036")).lines, ControlLines::DtrTalks);
  EXPECT_EQ(policy_for(port("dead", "beef")).lines, ControlLines::Unknown);
  EXPECT_EQ(policy_for(port("", "")).lines, ControlLines::Unknown);
}

TEST(UsbPolicy, OnlyBoardsThatRestartAreListenedToForLonger) {
  for (const UsbPolicy& policy : usb_policies()) {
    const auto opening = opening_of(port(std::string{policy.vendor}, std::string{policy.product}), true);
    EXPECT_EQ(opening.may_restart, policy.lines == ControlLines::DtrResets || policy.lines == ControlLines::Depends);
    EXPECT_FALSE(policy.source.empty());
  }
}

TEST(UsbPolicy, NoRowHidesALaterOne) {
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (const UsbPolicy& policy : usb_policies()) {
    EXPECT_FALSE(seen.contains({policy.vendor, ""})) << policy.name;
    EXPECT_TRUE(seen.insert({policy.vendor, policy.product}).second) << policy.name;
  }
}

}  // namespace
}  // namespace kerf::io
