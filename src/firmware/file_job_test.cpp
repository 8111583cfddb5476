#include "firmware/file_job.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

class FileJobTest : public ::testing::Test {
 protected:
  /// Every line as it comes, with the number that it has when its end comes.
  std::string lines_of(const std::string& contents) {
    card->put("/jobs/part.nc", contents);
    job.begin(card, "/jobs/part.nc", contents.size());
    std::string text;
    while (const auto byte = job.next(true)) {
      text += *byte == '\r' ? '\n' : *byte;
      if (text.back() == '\n') text.insert(text.size() - 1, ":" + std::to_string(job.line()));
    }
    return text;
  }

  std::shared_ptr<MemoryCard> card = std::make_shared<MemoryCard>();
  FileJob job;
};

TEST_F(FileJobTest, EveryFileEndsInOneMoreLineEnd) {
  EXPECT_EQ(lines_of("G21\nG0\n"), "G21:1\nG0:2\n:3\n");
  EXPECT_EQ(lines_of("G21\nG0"), "G21:1\nG0:2\n");
  EXPECT_EQ(lines_of(""), ":1\n");
}

TEST_F(FileJobTest, PairedLineEndsAreOne) {
  EXPECT_EQ(lines_of("a\r\nb\n\rc"), "a:1\nb:2\nc:3\n");
  EXPECT_EQ(lines_of("a\n\n\nb"), "a:1\n:2\n:3\nb:4\n");
}

TEST_F(FileJobTest, TellsHowFarItIs) {
  card->put("/part.nc", std::string(10'000, 'x'));
  job.begin(card, "/part.nc", 10'000);
  for (int byte = 0; byte < 5'000; ++byte) static_cast<void>(job.next(true));
  EXPECT_DOUBLE_EQ(job.percent(), 50.0);
  EXPECT_EQ(job.name(), "part.nc");
}

TEST_F(FileJobTest, ReadsOnAtAnotherPlace) {
  card->put("/part.nc", "a\r\nb\r\nc\r\n");
  job.begin(card, "/part.nc", 9);
  for (const char expected : {'a', '\r'}) EXPECT_EQ(job.next(true), expected);
  const auto place = job.position();
  for (const char expected : {'b', '\r', 'c', '\r'}) EXPECT_EQ(job.next(true), expected);
  job.go_to(place, 1);
  EXPECT_EQ(job.next(true), 'b');
  EXPECT_EQ(job.line(), 2);
}

TEST_F(FileJobTest, AStateThatReadsNothingClosesTheFile) {
  card->put("/part.nc", "G0\nG1\n");
  job.begin(card, "/part.nc", 6);
  EXPECT_EQ(job.next(true), 'G');
  EXPECT_EQ(job.next(false), '\n');
  EXPECT_TRUE(job.is_drained());
  EXPECT_EQ(job.next(true), std::nullopt);
  job.end();
  EXPECT_FALSE(job.is_running());
}

}  // namespace
}  // namespace kerf::firmware
