#include "common/protocol/secrets.hpp"

#include <gtest/gtest.h>

namespace kerf::protocol {
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

TEST(Secrets, ANumberIsHiddenWhereDescriptionsWereNotAskedFor) {
  Secrets secrets;
  secrets.learn_from("[NEWOPT:ENUMS,RT+,SED]");
  EXPECT_EQ(secrets.hidden("$9001=12345678"), "$9001=********");
  EXPECT_EQ(secrets.hidden("$9001="), "$9001=");
  EXPECT_EQ(secrets.hidden("$110=500.000"), "$110=500.000");
  secrets.learn_from("[SETTING:9002|1|Something|mm|6|###0|||0|0]");
  EXPECT_EQ(secrets.hidden("$9001=12345678"), "$9001=12345678");
}

TEST(Secrets, ANameMayTellIt) {
  const Secrets secrets;
  EXPECT_EQ(secrets.hidden("$Sta/Password=12345678"), "$Sta/Password=********");
}

TEST(Secrets, CommandsOfAnEspHoldPasswords) {
  const Secrets secrets;
  EXPECT_EQ(secrets.hidden("[ESP101]hunter2 pwd=admin"), "[ESP101]*****************");
  EXPECT_EQ(secrets.hidden("[esp401]P=1 T=S V=hunter2"), "[esp401]P=1 T=S V=*******");
  EXPECT_EQ(secrets.hidden("[ESP444]RESTART pwd=admin]"), "[ESP444]RESTART pwd=******");
  EXPECT_EQ(secrets.hidden("[ESP100]workshop"), "[ESP100]workshop");
  EXPECT_EQ(secrets.hidden("[MSG:V=5 pwd=none]"), "[MSG:V=5 pwd=none]");
}

TEST(Secrets, APieceOfALineIsHiddenByWhatStoodBefore) {
  const Secrets secrets;
  EXPECT_EQ(secrets.hidden_part("$75=hu", "nter2\r\nG1X1"), "*****\r\nG1X1");
  EXPECT_EQ(secrets.hidden_part("", "$75=hunter2"), "$75=*******");
  EXPECT_EQ(secrets.hidden_part("$110=5", "00.000"), "00.000");
}

TEST(Secrets, LeavesWordsAndStartupLinesAlone) {
  const Secrets secrets;
  for (const char* line :
       {"$J=G91X10F100", "$N0=G54G20", "$I=shop mill", "ok", "$$", "$RST=*", "G1X1 (costs $5=five)"}) {
    EXPECT_EQ(secrets.hidden(line), line);
  }
}

}  // namespace
}  // namespace kerf::protocol
