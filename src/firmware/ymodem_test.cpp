#include "firmware/ymodem.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "firmware/bench_for_tests.hpp"

namespace kerf::firmware {
namespace {

using namespace std::chrono_literals;
using ::testing::IsEmpty;

constexpr auto kAck = "\x06";
constexpr auto kAckC =
    "\x06"
    "C";
constexpr auto kNak = "\x15";
constexpr auto kCanCan = "\x18\x18";

std::string block(int number, std::string payload, std::size_t size = 128) {
  payload.resize(size, number == 0 ? '\0' : '\x1a');
  const std::uint16_t crc = crc16(payload);
  std::string bytes(1, size == 128 ? '\x01' : '\x02');
  bytes += static_cast<char>(number);
  bytes += static_cast<char>(~number);
  bytes += payload;
  bytes += static_cast<char>(crc >> 8U);
  bytes += static_cast<char>(crc & 0xFFU);
  return bytes;
}

std::string header(const std::string& name, std::size_t length) {
  return block(0, name + std::string(1, '\0') + std::to_string(length));
}

class YModemTest : public ::testing::Test {
 protected:
  YModemTest() { begin(); }

  void begin() { receiver.begin(now, card, "/"); }
  std::string send(std::string_view bytes) {
    std::string answer;
    for (const char byte : bytes) {
      if (!receiver.is_receiving()) break;
      answer += receiver.take(now, static_cast<std::uint8_t>(byte));
    }
    return answer;
  }
  std::string wait(Duration time) {
    now += time;
    return receiver.advance(now);
  }

  Instant now{};
  std::shared_ptr<MemoryCard> card = std::make_shared<MemoryCard>();
  YModem receiver;
};

TEST(Crc16, KnownValues) {
  EXPECT_EQ(crc16(""), 0U);
  EXPECT_EQ(crc16("123456789"), 0x31C3U);
}

TEST_F(YModemTest, AFileLands) {
  EXPECT_EQ(send(header("part.nc", 1100)), kAckC);
  EXPECT_EQ(send(block(1, std::string(1024, 'a'), 1024)), kAck);
  EXPECT_EQ(send(block(2, std::string(76, 'b'))), kAck);
  EXPECT_EQ(send("\x04"), kAckC);
  EXPECT_FALSE(receiver.is_receiving());
  EXPECT_EQ(card->contents("/part.nc"), std::string(1024, 'a') + std::string(76, 'b'));
  begin();
  EXPECT_EQ(send(block(0, "")), kAck);
  EXPECT_FALSE(receiver.is_receiving());
}

TEST_F(YModemTest, WithoutALengthNothingIsCutOff) {
  EXPECT_EQ(send(block(0, "part.nc")), kAckC);
  EXPECT_EQ(send(block(1, "G0")), kAck);
  EXPECT_EQ(send("\x04"), kAckC);
  EXPECT_EQ(card->contents("/part.nc")->size(), 128U);
}

TEST_F(YModemTest, ADamagedBlockIsRefusedAfterSilenceAndSentAgain) {
  send(header("part.nc", 100));
  std::string damaged = block(1, std::string(100, 'a'));
  damaged[10] = 'x';
  EXPECT_EQ(send(damaged), "");
  EXPECT_TRUE(receiver.take_purged());
  EXPECT_EQ(send("more noise"), "");
  EXPECT_EQ(wait(999ms), "");
  EXPECT_EQ(wait(1ms), kNak);
  EXPECT_EQ(send(block(1, std::string(100, 'a'))), kAck);
  EXPECT_EQ(send("\x04"), kAckC);
  EXPECT_EQ(card->contents("/part.nc"), std::string(100, 'a'));
}

TEST_F(YModemTest, ABlockOutOfOrderIsRefused) {
  send(header("part.nc", 1000));
  for (const int number : {0, 2, 3}) {
    EXPECT_EQ(send(block(number, "x")), "");
    EXPECT_EQ(wait(1s), kNak);
  }
  EXPECT_EQ(card->contents("/part.nc"), "");
}

TEST_F(YModemTest, BlockNumbersWrap) {
  send(header("part.nc", 128 * 300));
  for (int number = 1; number <= 300; ++number) {
    ASSERT_EQ(send(block(number & 0xFF, std::string(128, 'x'))), kAck) << number;
  }
  EXPECT_EQ(send("\x04"), kAckC);
  EXPECT_EQ(card->contents("/part.nc")->size(), 128U * 300U);
}

TEST_F(YModemTest, GivesUpAfterTenSilences) {
  for (int turn = 0; turn < 10; ++turn) EXPECT_EQ(wait(1s), kNak);
  EXPECT_EQ(wait(1s), "");
  EXPECT_FALSE(receiver.is_receiving());
  EXPECT_EQ(receiver.next_deadline(), kNever);
}

TEST_F(YModemTest, TwoCancelsEndIt) {
  send(header("part.nc", 1000));
  send(block(1, std::string(128, 'a')));
  EXPECT_EQ(send("\x18"), "");
  EXPECT_EQ(send("\x18"), "");
  EXPECT_FALSE(receiver.is_receiving());
  EXPECT_EQ(card->contents("/part.nc")->size(), 128U);
}

TEST_F(YModemTest, AFileThatCannotBeMadeIsCancelled) {
  EXPECT_EQ(send(header(std::string(32, 'n'), 10)), kCanCan);
  receiver.begin(now, nullptr, "/");
  EXPECT_EQ(send(header("part.nc", 10)), kCanCan);
  card->put("jobs/a.nc", "");
  begin();
  EXPECT_EQ(send(header("jobs", 10)), kCanCan);
}

TEST_F(YModemTest, ABlockTooManyIsCancelled) {
  send(header("part.nc", 10));
  EXPECT_EQ(send(block(1, "0123456789")), kAck);
  EXPECT_EQ(send(block(2, "more")), "");
  EXPECT_EQ(wait(1s), kNak);
  EXPECT_EQ(send(block(2, "more")), kCanCan);
  EXPECT_EQ(card->contents("/part.nc"), "0123456789");
}

TEST_F(YModemTest, AnySizeArrivesAsItWas) {
  rc::check("what lands is what was sent", [] {
    const auto text = *rc::gen::string<std::string>();
    const auto size = *rc::gen::element<std::size_t>(128, 1024);
    const auto files = std::make_shared<MemoryCard>();
    YModem transfer;
    transfer.begin(Instant{}, files, "/");
    std::string bytes = header("part.nc", text.size());
    int number = 0;
    for (std::size_t at = 0; at < text.size(); at += size) bytes += block(++number, text.substr(at, size), size);
    bytes += '\x04';
    for (const char byte : bytes) static_cast<void>(transfer.take(Instant{}, static_cast<std::uint8_t>(byte)));
    RC_ASSERT(!transfer.is_receiving());
    // Told that it has no bytes, the receiver does not cut; with none there is no block either.
    RC_ASSERT(files->contents("/part.nc") == text);
  });
}

TEST(YModemInController, TakesTheWireAndGivesItBack) {
  const auto files = std::make_shared<MemoryCard>();
  testing::Bench bench(vocabulary::Firmware::GrblHal, testing::Bench::factory(), {.card = files});
  bench.say("$FM");
  bench.controller.on_bytes(bench.now, header("up.nc", 20));
  EXPECT_EQ(bench.controller.take_outbox(), kAckC);
  bench.controller.on_bytes(bench.now, block(1, "G0X1?\nG0X2\x18!~\nG0X3\n"));
  EXPECT_EQ(bench.controller.take_outbox(), kAck);
  bench.controller.on_bytes(bench.now, "\x04");
  EXPECT_EQ(bench.controller.take_outbox(), kAckC);
  bench.controller.on_bytes(bench.now, block(0, ""));
  EXPECT_EQ(bench.controller.take_outbox(), kAck);
  EXPECT_EQ(bench.state(), "Idle");
  EXPECT_EQ(files->contents("/up.nc")->size(), 20U);
  bench.run_out();
}

TEST(YModemInController, AResetButtonCancels) {
  const auto files = std::make_shared<MemoryCard>();
  testing::Bench bench(vocabulary::Firmware::GrblHal, testing::Bench::factory(), {.card = files});
  bench.say("$FM");
  bench.controller.on_bytes(bench.now, header("up.nc", 20));
  static_cast<void>(bench.controller.take_outbox());
  bench.happens(InputChanged{.input = Input::Reset, .active = true});
  EXPECT_TRUE(bench.controller.take_outbox().starts_with(kCanCan));
}

TEST(YModemInController, WithoutACardNothingBegins) {
  testing::Bench bench(vocabulary::Firmware::GrblHal);
  EXPECT_THAT(bench.send(header("up.nc", 20)), IsEmpty());
  EXPECT_EQ(bench.controller.next_deadline(), kNever);
}

}  // namespace
}  // namespace kerf::firmware
