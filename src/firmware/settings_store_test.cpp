#include "firmware/settings_store.hpp"

#include <gtest/gtest.h>

namespace kerf::firmware {
namespace {

using vocabulary::Firmware;

struct Case {
  const char* key;
  const char* text;
  const char* stored;  ///< null if refused
  ErrorCode error = ErrorCode::Ok;
};

void expect_all(Firmware firmware, std::initializer_list<Case> cases) {
  for (const Case& each : cases) {
    SettingsStore store(personality_of(firmware));
    const auto written = store.write(each.key, each.text);
    EXPECT_EQ(written.has_value(), each.stored != nullptr) << each.key << "=" << each.text;
    if (each.stored != nullptr) {
      EXPECT_EQ(store.find(each.key)->text, each.stored);
    } else if (!written) {
      EXPECT_EQ(written.error(), each.error) << each.key << "=" << each.text;
    }
  }
}

TEST(SettingsStore, GrblHalChecks) {
  // T:04
  expect_all(Firmware::GrblHal, {{"10", "16383", "16383"},
                                 {"10", "16384", nullptr, ErrorCode::SettingOutOfRange},
                                 {"10", "-1", nullptr, ErrorCode::BadNumberFormat},
                                 {"11", "-1", nullptr, ErrorCode::NegativeValue},
                                 {"11", "0.02", "0.020"},
                                 {"11", "x", nullptr, ErrorCode::BadNumberFormat},
                                 {"0", "1", nullptr, ErrorCode::SettingOutOfRange},
                                 {"20", "1", nullptr, ErrorCode::SoftLimitNeedsHoming},
                                 {"40", "1", nullptr, ErrorCode::SoftLimitNeedsHoming},
                                 {"32", "3", nullptr, ErrorCode::SettingOutOfRange},
                                 {"481", "0", "0"},
                                 {"481", "50", nullptr, ErrorCode::SettingOutOfRange},
                                 {"22", "6", "0"},
                                 {"3", "+1", "1"},
                                 {"3", "1x", "1"},
                                 {"3", "1 ", "1"},
                                 {"3", "1.5", nullptr, ErrorCode::BadNumberFormat},
                                 {"3", "--1", nullptr, ErrorCode::BadNumberFormat},
                                 {"140", "1", nullptr, ErrorCode::SettingDisabled}});
}

TEST(SettingsStore, GrblChecks) {
  expect_all(Firmware::Grbl, {{"0", "2", nullptr, ErrorCode::StepPulseTooShort},
                              {"110", "700", "700.000"},
                              {"110", "-1", nullptr, ErrorCode::NegativeValue},
                              {"110", "7x", nullptr, ErrorCode::InvalidStatement},
                              {"13", "7", "1"},
                              {"1", "256", "0"},
                              {"103", "1", nullptr, ErrorCode::InvalidStatement}});
}

TEST(SettingsStore, RabbitChecks) {
  expect_all(Firmware::Rabbit, {{"0", "2", nullptr, ErrorCode::SettingNumberOutOfRange},
                                {"13", "on", "1"},
                                {"110", "abc", nullptr, ErrorCode::BadNumberFormat},
                                {"13", "maybe", "0"},
                                {"3", "xZ", "5"},
                                {"3", "-1", "-1"},
                                {"3", "xq", nullptr, ErrorCode::BadNumberFormat},
                                {"Spindle/Type", "laser", "LASER"},
                                {"Spindle/Type", "257", "PWM"},
                                {"Spindle/Type", "9", nullptr, ErrorCode::BadNumberFormat},
                                {"104", "7", "7.000"},
                                {"1", "1.5", nullptr, ErrorCode::BadNumberFormat},
                                {"73", "1", nullptr, ErrorCode::InvalidStatement},
                                {"77", "1", nullptr, ErrorCode::InvalidStatement}});
}

TEST(SettingsStore, SoftLimitsGoWithHoming) {
  SettingsStore store(personality_of(Firmware::GrblHal));
  ASSERT_TRUE(store.write("22", "1"));
  ASSERT_TRUE(store.write("20", "1"));
  ASSERT_TRUE(store.write("22", "0"));
  EXPECT_EQ(store.find("20")->text, "0");
}

TEST(SettingsStore, WhatWasWrittenActsWhateverIsPrinted) {
  SettingsStore store(personality_of(Firmware::Rabbit));
  ASSERT_TRUE(store.write("12", "0.0005"));
  EXPECT_EQ(store.find("12")->text, "0.001");
  EXPECT_FLOAT_EQ(store.motion().arc_tolerance_mm, 0.0005F);
}

TEST(SettingsStore, SavesOnlyWhatDiffers) {
  SettingsStore store(personality_of(Firmware::Grbl));
  ASSERT_TRUE(store.write("111", "800"));
  StoredState stored;
  store.save(stored);
  EXPECT_EQ(stored.settings.size(), 1U);
  EXPECT_EQ(stored.settings.at("111"), "800.000");
}

}  // namespace
}  // namespace kerf::firmware
