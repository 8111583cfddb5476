#include "firmware/receiver.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

using vocabulary::Firmware;
using Fate = Receiver::Fate;

TEST(Receiver, GrblStillHearsRealtimeBytesWhenFull) {
  Receiver receiver(personality_of(Firmware::Grbl));
  while (!receiver.full()) EXPECT_EQ(receiver.take('X', {}), Fate::Buffered);
  EXPECT_EQ(receiver.take('X', {}), Fate::Lost);
  EXPECT_EQ(receiver.take('!', {}), Fate::Realtime);
}

TEST(Receiver, RabbitLosesEverythingWhenFull) {
  Receiver receiver(personality_of(Firmware::Rabbit));
  while (!receiver.full()) EXPECT_EQ(receiver.take('X', {}), Fate::Buffered);
  EXPECT_EQ(receiver.take('!', {}), Fate::Lost);
}

TEST(Receiver, TextMayKeepSpecialBytesOnGrblHal) {
  Receiver receiver(personality_of(Firmware::GrblHal));
  EXPECT_EQ(receiver.take('?', {}), Fate::Realtime);
  EXPECT_EQ(receiver.take(0x7F, {}), Fate::Lost);
  EXPECT_EQ(receiver.take(0x7F, {.keeps_high_bytes = true}), Fate::Buffered);
  EXPECT_EQ(receiver.take('?', {.keeps_high_bytes = true}), Fate::Realtime);
  EXPECT_EQ(receiver.take('?', {.keeps_high_bytes = true, .keeps_printable_commands = true}), Fate::Buffered);
  EXPECT_EQ(receiver.take(0xC3, {.keeps_high_bytes = true}), Fate::Buffered);
}

TEST(Receiver, CancelLeavesItsMark) {
  Receiver receiver(personality_of(Firmware::GrblHal));
  static_cast<void>(receiver.take('G', {}));
  receiver.cancel();
  EXPECT_EQ(receiver.free(), 1022U);
  EXPECT_EQ(receiver.pop(), Receiver::kCancelMark);
}

TEST(Receiver, UnreadBytesCanBeSetAside) {
  Receiver receiver(personality_of(Firmware::GrblHal));
  for (const char byte : {'A', 'B'}) static_cast<void>(receiver.take(static_cast<std::uint8_t>(byte), {}));
  receiver.set_aside();
  EXPECT_TRUE(receiver.empty());
  receiver.restore();
  EXPECT_EQ(receiver.pop(), 'A');
}

}  // namespace
}  // namespace kerf::firmware
