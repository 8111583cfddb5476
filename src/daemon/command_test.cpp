#include "daemon/command.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace kerf::daemon {
namespace {

using io::Json;

template <typename Kind>
Kind parsed(std::string_view name, const char* text) {
  const auto command = parse_command(name, Json::parse(text));
  return command ? std::get<Kind>(*command) : Kind{};
}

std::string fault_of(std::string_view name, const char* text) {
  const auto command = parse_command(name, Json::parse(text));
  return command ? "" : command.error().where + ": " + command.error().what;
}

TEST(Command, HasItsMembers) {
  EXPECT_EQ(parsed<SetZero>("SetZero", R"({"axes":"XY","system":"G55"})").system, "G55");
  EXPECT_EQ(parsed<SetZero>("SetZero", R"({"axes":"XY"})").axes, "XY");
  EXPECT_EQ(parsed<JogStep>("JogStep", R"({"distance":{"X":-1.5},"feed_mm_per_min":100})").distance.at("X"), -1.5);
  EXPECT_EQ(parsed<Spindle>("Spindle", R"({"turn":"Counterclockwise","rpm":8000})").turn,
            machine::SpindleTurn::Counterclockwise);
  EXPECT_EQ(parsed<ChangeSettings>("ChangeSettings", R"({"settings":[{"id":"110","value":"500"}]})").settings[0].value,
            "500");
}

TEST(Command, SaysWhereItIsWrong) {
  EXPECT_EQ(fault_of("Jump", "{}"), "command: 'Jump' is not known here");
  EXPECT_EQ(fault_of("Hold", R"({"now":true})"), "now: is not known here");
  EXPECT_EQ(fault_of("Hold", "[]"), ": must be an object");
  EXPECT_EQ(fault_of("JogStep", R"({"distance":{"X":"1"}})"), "distance.X: must be a number");
  EXPECT_EQ(fault_of("SetOverride", R"({"feed":1.5})"), "feed: must be a whole number");
  EXPECT_EQ(fault_of("SetOverride", R"({"feed":99999999999})"), "feed: is out of range");
  EXPECT_EQ(fault_of("ChangeSettings", R"({"settings":[{"id":"1","value":"2"},{"id":7}]})"),
            "settings[1].id: must be a text");
  EXPECT_EQ(fault_of("Spindle", R"({"turn":"Sideways"})"), "turn: must be one of Off, Clockwise, Counterclockwise");
}

TEST(Command, OnlyWhatStopsIsForSafety) {
  EXPECT_TRUE(is_for_safety(Stop{}));
  EXPECT_TRUE(is_for_safety(Hold{}));
  EXPECT_TRUE(is_for_safety(CancelJog{}));
  EXPECT_FALSE(is_for_safety(Resume{}));
  EXPECT_FALSE(is_for_safety(Unlock{}));
}

TEST(Command, OfEveryNameIsRead) {
  for (const std::string_view name : kCommandNames)
    EXPECT_TRUE(parse_command(name, Json::object()).has_value()) << name;
}

RC_GTEST_PROP(Command, OfAnyJsonIsReadOrRefused, (const std::string& text, int value)) {
  Json members = Json::object();
  members["distance"] = {{text.substr(0, text.find('\0')), value}};
  members[*rc::gen::elementOf(std::vector<std::string>{"axes", "text", "feed", "settings", "position"})] =
      *rc::gen::elementOf(std::vector<Json>{nullptr, true, value, 1e300, "x", Json::array({Json::object()})});
  for (const std::string_view name : kCommandNames) static_cast<void>(parse_command(name, members));
}

}  // namespace
}  // namespace kerf::daemon
