#include "sender/machine/settings_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace kerf::machine {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(SettingsText, LinesAndRemarks) {
  const auto settings =
      parse_settings_text("\xEF\xBB\xBF# one\r\n; two\n\n  $110=500.000  \r\n$Spindle/Type = PWM\n$74=a;b#c=d\n$110=7");
  ASSERT_TRUE(settings);
  EXPECT_THAT(*settings, ElementsAre(SettingAssignment{"Spindle/Type", "PWM"}, SettingAssignment{"74", "a;b#c=d"},
                                     SettingAssignment{"110", "7"}));
}

TEST(SettingsText, AnythingElseIsNoSettingsFile) {
  EXPECT_EQ(parse_settings_text("$1=2\nG0X1\n").error(), (SettingsTextError{2, "G0X1"}));
  EXPECT_TRUE(parse_settings_text("$N0=G54"));
  EXPECT_FALSE(parse_settings_text("$I=mill"));
  EXPECT_FALSE(parse_settings_text("$I=mill"));
  EXPECT_FALSE(parse_settings_text("110=500"));
}

TEST(SettingsText, PrintsWithoutPasswords) {
  Capabilities machine;
  machine.settings = {{.id = "75", .name = "WiFi password", .type = 8},
                      {.id = "110", .name = "X rate", .unit = "mm/min"}};
  const std::string text = print_settings_text(machine, {{"75", "sesame"}, {"110", "500"}, {"7", "1"}}, {"taken: now"});
  EXPECT_THAT(text, Not(HasSubstr("sesame")));
  EXPECT_THAT(text, HasSubstr("; taken: now\n"));
  EXPECT_THAT(text, HasSubstr("; X rate, mm/min\n$110=500\n"));
  EXPECT_THAT(*parse_settings_text(text), ElementsAre(SettingAssignment{"110", "500"}, SettingAssignment{"7", "1"}));
}

TEST(SettingsText, Ids) {
  EXPECT_EQ(setting_id_of(" $110 "), "110");
  EXPECT_EQ(setting_id_of("Homing/Enable"), "Homing/Enable");
  EXPECT_EQ(setting_id_of("N0"), "N0");
  EXPECT_EQ(setting_id_of("$"), "");
}

TEST(SettingsText, WhatIsPrintedReadsBack) {
  EXPECT_TRUE(rc::check("round trip", [] {
    std::vector<SettingAssignment> settings;
    for (int id = *rc::gen::inRange(0, 5); id < 40; id += *rc::gen::inRange(1, 9)) {
      settings.push_back({std::to_string(id), *rc::gen::container<std::string>(
                                                  rc::gen::elementOf(std::string{"abcXYZ019.,;:-_()[]<>$%='\"/#"}))});
    }
    const auto back = parse_settings_text(print_settings_text({}, settings, {}));
    RC_ASSERT(back.has_value());
    RC_ASSERT(*back == settings);
  }));
}

}  // namespace
}  // namespace kerf::machine
