#include "sender/machine/stranger.hpp"

#include <gtest/gtest.h>

#include "common/vocabulary/dialect.hpp"

namespace kerf::machine {
namespace {

TEST(Stranger, NoWelcomeAndNoReportOfOursIsOne) {
  for (const auto* dialect : vocabulary::all_dialects()) EXPECT_EQ(find_stranger(dialect->welcome), nullptr);
  for (const char* line :
       {"<Idle|MPos:0.000,0.000,0.000|FS:0,0|WCO:0.000,0.000,0.000>", "ok", "error:9", "[VER:1.1f.20260817:]",
        "[OPT:VNML+,100,1024,3,0]", "[MSG:'$H'|'$X' to unlock]", "[echo: G1X1]"}) {
    EXPECT_EQ(find_stranger(line), nullptr) << line;
  }
}

TEST(Stranger, EveryRowSaysWhoItIsAndWhatToDo) {
  for (const StrangerRow& row : stranger_rows()) {
    EXPECT_FALSE(row.who.empty());
    EXPECT_TRUE(row.advice.ends_with('.')) << row.phrase;
    EXPECT_EQ(find_stranger(row.phrase)->failure, row.failure) << row.phrase;
  }
}

TEST(Overheard, KeepsTheEndOfALotOfNoise) {
  Overheard overheard;
  for (int count = 0; count < 1000; ++count) overheard.hear("0123456789");
  EXPECT_EQ(overheard.count(), 10'000U);
  EXPECT_LE(overheard.text().size(), 1024U);
  EXPECT_FALSE(overheard.is_noise());
  overheard.hear(std::string(900, '\xFE'));
  EXPECT_TRUE(overheard.is_noise());
}

TEST(Overheard, AnEchoIsAPieceOfWhatWasSent) {
  Overheard overheard;
  overheard.hear("\x87?");
  EXPECT_TRUE(overheard.is_echo_of("\x87??"));
  EXPECT_FALSE(overheard.is_echo_of("?"));
  EXPECT_FALSE(Overheard{}.is_echo_of("?"));
}

}  // namespace
}  // namespace kerf::machine
