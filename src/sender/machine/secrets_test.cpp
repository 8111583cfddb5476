#include "sender/machine/secrets.hpp"

#include <gtest/gtest.h>

namespace kerf::machine {
namespace {

TEST(Secrets, KnowsThePasswordSettingsOfTheTables) {
  const Secrets secrets;
  EXPECT_EQ(secrets.hidden("$75=hunter2"), "$75=*******");
  EXPECT_EQ(secrets.hidden("$330=a=b"), "$330=***");
  EXPECT_EQ(secrets.hidden("$74=workshop"), "$74=workshop");
  EXPECT_EQ(secrets.hidden("$110=500.000"), "$110=500.000");
  EXPECT_EQ(secrets.hidden("$75="), "$75=");
}

TEST(Secrets, ReadsTheNumberAsFirmwareDoes) {
  const Secrets secrets;
  EXPECT_EQ(secrets.hidden("$ 0 75 =hunter2"), "$ 0 75 =*******");
  EXPECT_EQ(secrets.hidden("[echo: $75=hunter2]"), "[echo: $75=*******]");
  EXPECT_EQ(secrets.hidden("$N0=$75=hunter2"), "$N0=$75=*******");
}

TEST(Secrets, ATextThatNobodyDescribedIsHiddenUntilItsRowComes) {
  Secrets secrets;
  EXPECT_EQ(secrets.hidden("$9001=hunter2"), "$9001=*******");
  EXPECT_EQ(secrets.hidden("$9001=12.5"), "$9001=12.5");
  secrets.learn({.id = 9001, .type = 7});
  EXPECT_EQ(secrets.hidden("$9001=plain"), "$9001=plain");
  secrets.learn({.id = 9001, .type = 8});
  EXPECT_EQ(secrets.hidden("$9001=12345678"), "$9001=********");
}

TEST(Secrets, LeavesWordsAndStartupLinesAlone) {
  const Secrets secrets;
  for (const char* line :
       {"$J=G91X10F100", "$N0=G54G20", "$I=shop mill", "ok", "$$", "$RST=*", "G1X1 (costs $5=five)"}) {
    EXPECT_EQ(secrets.hidden(line), line);
  }
}

}  // namespace
}  // namespace kerf::machine
