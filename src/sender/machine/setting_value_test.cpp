#include "sender/machine/setting_value.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "common/base/text.hpp"
#include "common/vocabulary/settings.hpp"

namespace kerf::machine {
namespace {

using vocabulary::SettingType;

SettingFact of_type(SettingType type, std::string format = {}) {
  return {.id = "7", .name = "Thing", .type = static_cast<int>(type), .format = std::move(format)};
}

/// What would be sent, or the name of the fault.
std::string sent(const SettingFact& setting, std::string_view text, const SettingRules& rules = {}) {
  const auto checked = check_setting(setting, text, rules);
  return checked ? *checked : boost::describe::enum_to_string(checked.error().fault, "?");
}

TEST(SettingValue, Bool) {
  const auto setting = of_type(SettingType::Bool);
  EXPECT_EQ(sent(setting, "on"), "1");
  EXPECT_EQ(sent(setting, " No "), "0");
  EXPECT_EQ(sent(setting, "2"), "UnknownItem");
  EXPECT_EQ(sent(setting, ""), "Empty");
}

TEST(SettingValue, BitField) {
  auto setting = of_type(SettingType::Bitfield, "Probe,N/A,Door & lid");
  EXPECT_EQ(sent(setting, "5"), "5");
  EXPECT_EQ(sent(setting, "door & lid,probe"), "5");
  EXPECT_EQ(sent(setting, "none"), "0");
  EXPECT_EQ(sent(setting, "8"), "UnknownItem");
  EXPECT_EQ(sent(setting, "N/A"), "UnknownItem");
  EXPECT_EQ(sent(setting, "-1"), "UnknownItem");
  setting.value = "4";
  EXPECT_EQ(sent(setting, "+Probe"), "5");
  EXPECT_EQ(sent(setting, "-Door & lid,+Probe"), "1");
  EXPECT_EQ(sent(setting, "+Probe,Door & lid"), "UnknownItem");
}

// protocol.md 5.2: bit 0 enables the rest.
TEST(SettingValue, ExclusiveBitField) {
  auto setting = of_type(SettingType::ExclusiveBitfield, "Enable,Strict mode");
  EXPECT_EQ(sent(setting, "3"), "3");
  EXPECT_EQ(sent(setting, "2"), "0");
  setting.value = "3";
  EXPECT_EQ(sent(setting, "-Enable"), "0");
  EXPECT_EQ(sent(setting, "-Strict mode"), "1");
}

TEST(SettingValue, RadioTakesNumbersAndNames) {
  const auto setting = of_type(SettingType::Radio, "Normal,Laser mode,Lathe mode");
  EXPECT_EQ(sent(setting, "1"), "1");
  EXPECT_EQ(sent(setting, "lathe mode"), "2");
  EXPECT_EQ(sent(setting, "3"), "UnknownItem");
  EXPECT_EQ(sent(setting, "-1"), "UnknownItem");
  EXPECT_TRUE(is_same_value(setting, "Laser mode", "1"));
  EXPECT_FALSE(is_same_value(setting, "Nothing", "Something"));
}

TEST(SettingValue, AxisMask) {
  auto setting = of_type(SettingType::Axes);
  const SettingRules rules{.axis_letters = "XYZA"};
  EXPECT_EQ(sent(setting, "xz", rules), "5");
  EXPECT_EQ(sent(setting, "A", rules), "8");
  EXPECT_EQ(sent(setting, "15", rules), "15");
  EXPECT_EQ(sent(setting, "16", rules), "UnknownAxis");
  EXPECT_EQ(sent(setting, "XB", rules), "UnknownAxis");
  setting.value = "1";
  EXPECT_EQ(sent(setting, "+Z", rules), "5");
  EXPECT_EQ(explain_value(setting, "9", rules), "X, A");
}

// grblHAL settings.c: no minimum means not negative; 0 may be allowed below the minimum.
TEST(SettingValue, NumbersAndTheirRanges) {
  auto setting = of_type(SettingType::Decimal, "#0.0");
  EXPECT_EQ(sent(setting, "12.5"), "12.5");
  EXPECT_EQ(sent(setting, "-0.1"), "Negative");
  EXPECT_EQ(sent(setting, "1,5"), "NotANumber");
  EXPECT_EQ(sent(setting, "1e3"), "NotANumber");
  setting.min = "0.5";
  setting.max = "20";
  EXPECT_EQ(sent(setting, "0"), "TooSmall");
  EXPECT_EQ(sent(setting, "20.01"), "TooLarge");
  setting.allow_null = true;
  EXPECT_EQ(sent(setting, "0"), "0");
  EXPECT_EQ(sent(setting, "0.4"), "TooSmall");
  setting.min = "-100";
  EXPECT_EQ(sent(setting, "-100"), "-100");
  setting.type = static_cast<int>(SettingType::Integer);
  EXPECT_EQ(sent(setting, "3.5"), "NotWhole");
  EXPECT_EQ(sent(setting, "x"), "NotANumber");
  setting.type = 11;  // grblHAL's 16 bits
  EXPECT_EQ(sent(setting, "7"), "7");
}

TEST(SettingValue, TextsAddressesAndPasswords) {
  auto text = of_type(SettingType::Text, "x(8)");
  text.max = "8";
  EXPECT_EQ(sent(text, "a=b;c#d"), "a=b;c#d");
  EXPECT_EQ(sent(text, "123456789"), "TooLong");
  EXPECT_EQ(sent(text, "really?"), "RealtimeCharacter");
  EXPECT_EQ(sent(text, "really?", {.legacy_realtime = false}), "really?");
  EXPECT_EQ(sent(text, "caf\xC3\xA9"), "NotPrintable");
  text.min = "3";
  EXPECT_EQ(sent(text, ""), "TooShort");
  text.allow_null = true;
  EXPECT_EQ(sent(text, ""), "");
  const auto address = of_type(SettingType::Ipv4);
  EXPECT_EQ(sent(address, "192.168.5.1"), "192.168.5.1");
  for (const auto* wrong : {"1.2.3", "1.2.3.256", "a.b.c.d", "1.2.3.4.5", "1..2.3", "-1.2.3.4"}) {
    EXPECT_EQ(sent(address, wrong), "NotAnAddress") << wrong;
  }
  auto password = of_type(SettingType::Password);
  password.max = "4";
  const auto refused = check_setting(password, "sesame", {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().sentence.find("sesame"), std::string::npos);
  EXPECT_EQ(explain_value(password, "x", {}), kStars);
}

TEST(SettingValue, ARefusalSaysWhatIsAllowed) {
  SettingFact setting = of_type(SettingType::Decimal);
  setting.min = "0.5";
  setting.max = "20";
  setting.unit = "s";
  setting.allow_null = true;
  EXPECT_EQ(check_setting(setting, "99", {}).error().sentence,
            "$7 (Thing) cannot be '99': it takes a number from 0.5 to 20 s, or 0.");
}

TEST(SettingValue, ALineThatIsTooLongIsNotSent) {
  const auto setting = of_type(SettingType::Text);
  EXPECT_EQ(sent(setting, std::string(20, 'a'), {.line_length = 20}), "TooLong");
}

TEST(SettingValue, SameValues) {
  const auto decimal = of_type(SettingType::Decimal);
  EXPECT_TRUE(is_same_value(decimal, "500", "500.000"));
  EXPECT_TRUE(is_same_value(decimal, "0.0125", "0.013"));
  EXPECT_FALSE(is_same_value(decimal, "0.02", "0.030"));
  EXPECT_FALSE(is_same_value(decimal, "500", "500.500"));
  EXPECT_TRUE(is_same_value(decimal, "12345.678", "12345.679"));  // a float has seven digits
  const auto text = of_type(SettingType::Text);
  EXPECT_FALSE(is_same_value(text, "1", "1.0"));
}

TEST(SettingValue, WhateverIsGivenOnlySafeLinesAreSent) {
  EXPECT_TRUE(rc::check("safe lines", [] {
    SettingFact setting{.id = "7", .type = *rc::gen::inRange(-1, 13)};
    setting.format = *rc::gen::element<std::string>("", "a,b,c", "#0.0", "x(8)", "N/A,N/A");
    setting.min = *rc::gen::element<std::string>("", "2", "-5", "x");
    setting.max = *rc::gen::element<std::string>("", "9", "30");
    setting.allow_null = *rc::gen::arbitrary<bool>();
    const auto text = *rc::gen::arbitrary<std::string>();
    const auto checked = check_setting(setting, text, {});
    if (!checked) return;
    RC_ASSERT(checked->find_first_of("?!~\n\r") == std::string::npos);
    // What was checked once is taken as it is.
    RC_ASSERT(check_setting(setting, *checked, {}).value() == *checked);
    RC_ASSERT(is_same_value(setting, *checked, *checked));
  }));
}

TEST(SettingValue, NumbersInRangeAreTakenAndOthersAreNot) {
  EXPECT_TRUE(rc::check("ranges", [] {
    const int least = *rc::gen::inRange(-50, 50);
    const int most = least + *rc::gen::inRange(0, 50);
    const int value = *rc::gen::inRange(-120, 120);
    SettingFact setting{.id = "7", .type = static_cast<int>(SettingType::Integer)};
    setting.min = std::to_string(least);
    setting.max = std::to_string(most);
    const bool is_in_range = value >= least && value <= most;
    RC_ASSERT(check_setting(setting, std::to_string(value), {}).has_value() == is_in_range);
  }));
}

TEST(SettingValue, NamesOfBitsSpellTheirNumber) {
  EXPECT_TRUE(rc::check("bits", [] {
    const SettingFact setting{.id = "7", .type = static_cast<int>(SettingType::Bitfield), .format = "a,b,c,d,e"};
    const auto mask = std::to_string(*rc::gen::inRange(0, 32));
    RC_ASSERT(check_setting(setting, explain_value(setting, mask, {}), {}).value() == mask);
  }));
}

}  // namespace
}  // namespace kerf::machine
