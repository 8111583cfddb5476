#include "firmware/byte_faults.hpp"

#include <bit>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::firmware {
namespace {

using namespace std::chrono_literals;
using testing::IsEmpty;
using testing::SizeIs;

constexpr Instant kStart{};

std::string through(ByteFaults& wire, std::string_view bytes, Instant now = kStart) {
  wire.send(now, bytes);
  return wire.take_arrived(now);
}

TEST(ByteFaults, AHealthyWireChangesNothing) {
  ByteFaults wire(1);
  EXPECT_EQ(through(wire, "G1X1\n"), "G1X1\n");
  EXPECT_EQ(wire.next_deadline(), kNever);
  EXPECT_THAT(wire.take_records(), IsEmpty());
}

TEST(ByteFaults, TheNextBytesAreHitAndNoOthers) {
  ByteFaults wire(1);
  wire.order({.kind = ByteFault::Drop, .next_bytes = 2});
  EXPECT_EQ(through(wire, "G"), "");
  EXPECT_EQ(through(wire, "1X1\n"), "X1\n");
  const auto records = wire.take_records();
  ASSERT_THAT(records, SizeIs(1));
  EXPECT_EQ(records[0].first, 1U);
  EXPECT_EQ(records[0].bytes, "G1");
  wire.order({.kind = ByteFault::Duplicate, .next_bytes = 1});
  EXPECT_EQ(through(wire, "?~"), "??~");
}

TEST(ByteFaults, ACorruptByteDiffersInOneBit) {
  rc::check("one bit", [](std::uint64_t seed, char byte) {
    ByteFaults wire(seed);
    wire.order({.kind = ByteFault::Corrupt, .next_bytes = 1});
    const std::string arrived = through(wire, std::string(1, byte));
    RC_ASSERT(arrived.size() == 1U);
    RC_ASSERT(std::popcount(static_cast<unsigned>(static_cast<unsigned char>(arrived[0] ^ byte))) == 1);
    RC_ASSERT(wire.take_records().at(0).became == arrived);
  });
}

TEST(ByteFaults, ALateByteIsNotOvertaken) {
  ByteFaults wire(1);
  wire.order({.kind = ByteFault::Delay, .next_bytes = 1, .delay = 50ms});
  EXPECT_EQ(through(wire, "!ok"), "");
  EXPECT_EQ(wire.bytes_on_the_way(), 3U);
  EXPECT_EQ(wire.next_deadline(), kStart + 50ms);
  EXPECT_EQ(wire.take_arrived(kStart + 49ms), "");
  EXPECT_EQ(wire.take_arrived(kStart + 50ms), "!ok");
  EXPECT_EQ(through(wire, "x", kStart + 1s), "x");
}

TEST(ByteFaults, ALatencyIsADelayOfEveryByte) {
  ByteFaults wire(1);
  wire.order({.kind = ByteFault::Delay, .rate = 1, .delay = 20ms});
  wire.send(kStart, "a");
  wire.send(kStart + 5ms, "b");
  EXPECT_EQ(wire.take_arrived(kStart + 20ms), "a");
  EXPECT_EQ(wire.take_arrived(kStart + 25ms), "b");
  wire.send(kStart + 30ms, "c");
  wire.cut();
  EXPECT_EQ(wire.next_deadline(), kNever);
}

TEST(ByteFaults, ChanceIsRepeatableAndCutsDoNotMatter) {
  rc::check("same seed, same faults", [](std::uint64_t seed, const std::string& bytes, std::size_t cut) {
    const auto play = [&](std::size_t at) {
      ByteFaults wire(seed);
      for (const ByteFault kind : {ByteFault::Drop, ByteFault::Duplicate, ByteFault::Corrupt}) {
        wire.order({.kind = kind, .rate = 0.2});
      }
      std::string arrived = through(wire, bytes.substr(0, at));
      return arrived += through(wire, bytes.substr(at));
    };
    RC_ASSERT(play(0) == play(cut % (bytes.size() + 1)));
  });
}

TEST(ByteFaults, TheRateIsMet) {
  ByteFaults wire(7);
  wire.order({.kind = ByteFault::Drop, .rate = 0.1});
  const auto arrived = through(wire, std::string(100'000, 'x')).size();
  EXPECT_NEAR(static_cast<double>(arrived), 90'000, 600);
  wire.end_orders();
  EXPECT_EQ(through(wire, "abc"), "abc");
}

}  // namespace
}  // namespace kerf::firmware
