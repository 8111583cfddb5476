#include "common/protocol/message_reader.hpp"

#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace kerf::protocol {
namespace {

std::vector<std::string> raws_of(const std::vector<ReceivedMessage>& messages) {
  std::vector<std::string> raws;
  raws.reserve(messages.size());
  for (const ReceivedMessage& message : messages) raws.push_back(message.raw);
  return raws;
}

TEST(MessageReader, CutsLinesAtAnyLineEnd) {
  MessageReader reader;
  const auto messages = reader.read("\r\nGrbl 1.1h ['$' for help]\r\nok\n\r\n[MSG:]\rerror:5\r\n");
  EXPECT_EQ(raws_of(messages), (std::vector<std::string>{"Grbl 1.1h ['$' for help]", "ok", "[MSG:]", "error:5"}));
  EXPECT_TRUE(std::holds_alternative<Welcome>(messages[0].message));
  EXPECT_TRUE(std::holds_alternative<Ok>(messages[1].message));
  EXPECT_TRUE(std::holds_alternative<Feedback>(messages[2].message));
  EXPECT_TRUE(std::holds_alternative<ErrorAnswer>(messages[3].message));
  EXPECT_EQ(reader.pending(), "");
}

TEST(MessageReader, KeepsAnUnfinishedLine) {
  MessageReader reader;
  EXPECT_TRUE(reader.read("<Idle|MPos:0.0").empty());
  EXPECT_EQ(reader.pending(), "<Idle|MPos:0.0");
  const auto messages = reader.read("00,1.000>\r");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].raw, "<Idle|MPos:0.000,1.000>");
  EXPECT_TRUE(reader.read("\n").empty());
}

TEST(MessageReader, ResetForgetsTheUnfinishedLine) {
  MessageReader reader;
  EXPECT_TRUE(reader.read("garb").empty());
  reader.reset();
  EXPECT_EQ(raws_of(reader.read("ok\r\n")), (std::vector<std::string>{"ok"}));
}

TEST(MessageReader, LongLinesComeInPiecesThatAreNeverDecoded) {
  MessageReader reader;
  const std::string long_line(MessageReader::kLongestLine, 'x');
  EXPECT_TRUE(reader.read(long_line).empty());
  EXPECT_EQ(reader.pending().size(), MessageReader::kLongestLine);
  const auto messages = reader.read("ok\nok\n");
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(messages[0].raw, long_line);
  EXPECT_EQ(messages[1].message, (Message{Unrecognized{"ok"}}));  // the rest of the long line
  EXPECT_EQ(messages[2].message, Message{Ok{}});
}

TEST(MessageReader, ALineOfTheGreatestLengthIsOneLine) {
  MessageReader reader;
  std::string line = "[MSG:" + std::string(MessageReader::kLongestLine - 6, 'x') + "]";
  const auto messages = reader.read(line + "\r\n");
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Feedback>(messages[0].message));
}

TEST(MessageReader, ChunkingChangesNothing) {
  EXPECT_TRUE(rc::check("chunking", [] {
    const auto piece = rc::gen::elementOf(std::vector<std::string>{
        "ok", "\r\n", "\n", "\r", "error:", "20", "<Idle|", "MPos:0.000,1.000,2.000", ">", "[MSG:", "]", "Grbl 1.1h ",
        std::string(1000, 'y'), std::string("\0\xFF", 2), "$110=5", "ALARM:1"});
    std::string bytes;
    for (const std::string& part : *rc::gen::container<std::vector<std::string>>(piece)) bytes += part;
    MessageReader whole_reader;
    const std::vector<ReceivedMessage> whole = whole_reader.read(bytes);

    MessageReader reader;
    std::vector<ReceivedMessage> pieces;
    for (std::size_t at = 0; at < bytes.size();) {
      const auto length = static_cast<std::size_t>(*rc::gen::inRange(1, 1500));
      for (ReceivedMessage& message : reader.read(std::string_view{bytes}.substr(at, length))) {
        pieces.push_back(std::move(message));
      }
      at += length;
      RC_ASSERT(reader.pending().size() <= MessageReader::kLongestLine);
    }
    RC_ASSERT(pieces == whole);
    RC_ASSERT(reader.pending() == whole_reader.pending());
  }));
}

// Nothing is lost but line ends.
TEST(MessageReader, RawLinesAreTheBytes) {
  EXPECT_TRUE(rc::check("raw lines", [] {
    const std::string bytes = *rc::gen::container<std::string>(rc::gen::elementOf(std::string{"ok\r\n<>[]MSG:"}));
    MessageReader reader;
    std::string seen;
    for (const ReceivedMessage& message : reader.read(bytes)) seen += message.raw;
    seen += reader.pending();
    std::string expected;
    for (const char letter : bytes) {
      if (letter != '\r' && letter != '\n') expected += letter;
    }
    RC_ASSERT(seen == expected);
  }));
}

}  // namespace
}  // namespace kerf::protocol
