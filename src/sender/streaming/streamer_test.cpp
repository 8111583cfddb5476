#include "sender/streaming/streamer.hpp"

#include <deque>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "sender/streaming/window.hpp"

namespace kerf::streaming {
namespace {

class ListSource final : public LineSource {
 public:
  explicit ListSource(std::deque<std::string> lines) : lines_(std::move(lines)) {}
  std::optional<SourceLine> next() override {
    if (lines_.empty()) return std::nullopt;
    return SourceLine{.file_line = number_, .file_offset_after = std::uint64_t{number_} * 10, .text = lines_.front()};
  }
  void move_on() override {
    lines_.pop_front();
    ++number_;
  }

 private:
  std::deque<std::string> lines_;
  std::uint32_t number_ = 1;
};

std::string pump(Streamer& streamer) {
  std::string out;
  static_cast<void>(streamer.pump(Instant{}, out));
  return out;
}

TEST(Streamer, FillsTheWindowAndNoMore) {
  Streamer streamer;
  streamer.configure(8, SoloPolicy::DollarLines);
  streamer.feed_from(std::make_unique<ListSource>(std::deque<std::string>{"G1", "G2", "G3", "G4"}));
  EXPECT_EQ(pump(streamer), "G1\nG2\n");
  EXPECT_EQ(streamer.ledger().bytes_in_flight(), 6U);
  EXPECT_EQ(streamer.settle()->text, "G1");
  EXPECT_EQ(pump(streamer), "G3\n");
}

TEST(Streamer, SendsALineLongerThanTheWindowAlone) {
  Streamer streamer;
  streamer.configure(4, SoloPolicy::DollarLines);
  streamer.feed_from(std::make_unique<ListSource>(std::deque<std::string>{"G0", "G1X100Y100", "G2"}));
  EXPECT_EQ(pump(streamer), "G0\n");
  EXPECT_TRUE(streamer.settle());
  EXPECT_EQ(pump(streamer), "G1X100Y100\n");
  EXPECT_TRUE(streamer.settle());
  EXPECT_EQ(pump(streamer), "G2\n");
}

TEST(Streamer, EepromWritersTravelAlone) {
  Streamer streamer;
  streamer.configure(100, SoloPolicy::StoredWritesToo);
  streamer.feed_from(std::make_unique<ListSource>(std::deque<std::string>{"G0X1", "G10L20P1X0", "G0X2", "G0X3"}));
  EXPECT_EQ(pump(streamer), "G0X1\n");
  EXPECT_TRUE(streamer.settle());
  EXPECT_EQ(pump(streamer), "G10L20P1X0\n");
  EXPECT_EQ(pump(streamer), "");
  EXPECT_TRUE(streamer.settle());
  EXPECT_EQ(pump(streamer), "G0X2\nG0X3\n");
}

TEST(Streamer, SingleLinesGoBeforeTheSource) {
  Streamer streamer;
  streamer.configure(100, SoloPolicy::DollarLines);
  streamer.enqueue(Purpose::ClearLatch, "");
  streamer.feed_from(std::make_unique<ListSource>(std::deque<std::string>{"G0X1"}));
  EXPECT_EQ(pump(streamer), "\nG0X1\n");
}

TEST(Streamer, StopsFeedingAtOnce) {
  Streamer streamer;
  streamer.configure(5, SoloPolicy::DollarLines);
  streamer.feed_from(std::make_unique<ListSource>(std::deque<std::string>{"G1", "G2", "G3"}));
  EXPECT_EQ(pump(streamer), "G1\n");
  streamer.stop_feeding();
  EXPECT_TRUE(streamer.settle());
  EXPECT_EQ(pump(streamer), "");
  EXPECT_TRUE(streamer.source_exhausted());
  EXPECT_TRUE(streamer.done_with(Purpose::JobLine));
}

TEST(Streamer, StrikingOutNamesTheLinesLost) {
  Streamer streamer;
  streamer.configure(100, SoloPolicy::DollarLines);
  streamer.feed_from(std::make_unique<ListSource>(std::deque<std::string>{"G1", "G2"}));
  EXPECT_EQ(pump(streamer), "G1\nG2\n");
  const auto lost = streamer.strike_out();
  ASSERT_EQ(lost.size(), 2U);
  EXPECT_EQ(lost[0].file_line, 1U);
  EXPECT_EQ(lost[1].text, "G2");
  EXPECT_FALSE(streamer.settle());
  EXPECT_EQ(streamer.ledger().lines_struck_out(), 2U);
}

TEST(SoloLines, KnowsTheWritersOnly) {
  const auto policy = SoloPolicy::StoredWritesToo;
  EXPECT_TRUE(must_travel_alone("$110=500", SoloPolicy::DollarLines));
  EXPECT_TRUE(must_travel_alone("N10G10L2P1X0", policy));
  EXPECT_TRUE(must_travel_alone("g028.1", policy));
  EXPECT_TRUE(must_travel_alone("G 30.1", policy));
  EXPECT_FALSE(must_travel_alone("G28X0", policy));
  EXPECT_FALSE(must_travel_alone("G1X10", policy));
  EXPECT_FALSE(must_travel_alone("G101", policy));
  EXPECT_FALSE(must_travel_alone("G1X1(G10)", policy));
  EXPECT_FALSE(must_travel_alone("G10L20P1X0", SoloPolicy::DollarLines));
  EXPECT_TRUE(must_travel_alone("G1", SoloPolicy::EveryLine));
}

TEST(Window, IsTheLeastOfBufferAndTwentyFiveMilliseconds) {
  EXPECT_EQ(window_bytes(128, {.baud = 115200}), 127U);
  EXPECT_EQ(window_bytes(1023, {.baud = 115200}), 288U);
  EXPECT_EQ(window_bytes(1023, {.baud = 9600}), 24U);
  EXPECT_EQ(window_bytes(1023, {.baud = std::nullopt, .network = true}), 256U);
  EXPECT_EQ(window_bytes(1023, {}), 1022U);
}

// Random lines, answers and losses in any order: the account is never overdrawn, and every line is settled or struck
// out once.
RC_GTEST_PROP(Streamer, NeverExceedsTheWindow, ()) {
  const auto window = *rc::gen::inRange<std::size_t>(1, 200);
  const auto lengths = *rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 90));
  std::deque<std::string> lines;
  for (const auto length : lengths) lines.push_back(std::string(length, 'X'));
  Streamer streamer;
  streamer.configure(window, SoloPolicy::StoredWritesToo);
  streamer.feed_from(std::make_unique<ListSource>(lines));
  std::vector<bool> answered(lengths.size() + 1000, false);
  std::string wire;
  for (int round = 0; round < 300; ++round) {
    for (const auto& line : streamer.pump(Instant{}, wire))
      RC_ASSERT(line.serial == streamer.ledger().lines_entered() || line.serial > 0);
    const auto& ledger = streamer.ledger();
    RC_ASSERT(ledger.bytes_in_flight() <= window || ledger.size() == 1U);
    RC_ASSERT(ledger.lines_entered() == ledger.lines_settled() + ledger.lines_struck_out() + ledger.size());
    const auto what = *rc::gen::inRange(0, 12);
    if (what == 0) {
      for (const auto& line : streamer.strike_out()) {
        RC_ASSERT(!answered[line.serial]);
        answered[line.serial] = true;
      }
    } else if (what == 1) {
      streamer.enqueue(Purpose::Question, "$G");
    } else if (const auto line = streamer.settle()) {
      RC_ASSERT(!answered[line->serial]);
      answered[line->serial] = true;
    }
  }
}

}  // namespace
}  // namespace kerf::streaming
