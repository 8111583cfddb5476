#include "sender/session/password_mask.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace kerf::session {
namespace {

constexpr std::string_view kHeard =
    "$74=workshop\r\n[ESP101]hunt4\r\n$75=hunter2\r\nok\r\n[SETTING:9001|1|Broker "
    "password||8|x(32)||32|0|0]\r\n$9001=12345\r\n"
    "$77=hunter3\r\n$75=hunter2\r\n<Idle|MPos:0.000,0.000,0.000>\r\n";
constexpr std::string_view kShown =
    "$74=workshop\r\n[ESP101]****1\r\n$75=******1\r\nok\r\n[SETTING:9001|1|Broker "
    "password||8|x(32)||32|0|0]\r\n$9001=****2\r\n"
    "$77=******2\r\n$75=******1\r\n<Idle|MPos:0.000,0.000,0.000>\r\n";

TEST(PasswordMask, TellsPasswordsApartWithoutShowingThem) {
  PasswordMask mask;
  EXPECT_EQ(mask.token_of("hunter2"), "******1");
  EXPECT_EQ(mask.token_of("hunter3"), "******2");
  EXPECT_EQ(mask.token_of("hunter2"), "******1");
  EXPECT_EQ(mask.token_of("*******"), "*******");
  EXPECT_EQ(mask.token_of("long one"), "*******1");
}

RC_GTEST_PROP(PasswordMask, CutsDoNotMatter, ()) {
  PasswordMask mask;
  StreamMask stream;
  std::string shown;
  for (std::size_t at = 0; at < kHeard.size();) {
    const auto size = *rc::gen::inRange<std::size_t>(1, 20);
    shown += stream.push(kHeard.substr(at, size), mask);
    RC_ASSERT(shown.find("hunt") == std::string::npos);
    at += size;
  }
  shown += stream.finish();
  RC_ASSERT(shown == kShown);
}

TEST(PasswordMask, AMaskedLogStaysAsItIs) {
  PasswordMask mask;
  StreamMask stream;
  EXPECT_EQ(stream.push(kShown, mask), kShown);
}

TEST(PasswordMask, WhatIsCutOffByTheEndOfTheLinkIsStars) {
  PasswordMask mask;
  StreamMask stream;
  EXPECT_EQ(stream.push("ok\r\n$75=hun", mask), "ok\r\n$75=");
  EXPECT_EQ(stream.finish(), "***");
  EXPECT_EQ(stream.push("ok", mask), "ok");
}

TEST(PasswordMask, ALineWithoutEndIsBounded) {
  PasswordMask mask;
  StreamMask stream;
  const std::string endless = "$75=" + std::string(100'000, 'x');
  const std::string shown = stream.push(endless, mask) + stream.finish();
  EXPECT_EQ(shown.size(), endless.size());
}

}  // namespace
}  // namespace kerf::session
