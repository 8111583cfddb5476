#include "common/base/json_text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

namespace kerf::base {
namespace {

TEST(JsonText, ReadsObjectsArraysAndWords) {
  const auto value =
      parse_json(R"( {"at": 1.500, "on":true, "off":false, "none":null, "list":["a", -2], "in":{"x":1}} )");
  ASSERT_TRUE(value);
  EXPECT_EQ(value->find("at")->text, "1.500");
  EXPECT_TRUE(value->find("on")->truth);
  EXPECT_FALSE(value->find("off")->truth);
  EXPECT_EQ(value->find("none")->kind, JsonValue::Kind::Null);
  ASSERT_EQ(value->find("list")->elements.size(), 2U);
  EXPECT_EQ(value->find("list")->elements[1].text, "-2");
  EXPECT_EQ(value->find("in")->find("x")->text, "1");
  EXPECT_EQ(value->find("absent"), nullptr);
}

TEST(JsonText, RefusesWhatIsNotJson) {
  for (const char* text : {"", "{", "{\"a\"}", "[1,]", "\"open", "\"\\q\"", "\"\\u12\"", "tru", "{} x", "'a'"}) {
    EXPECT_FALSE(parse_json(text)) << text;
  }
  EXPECT_FALSE(parse_json(std::string(100, '[')));
}

TEST(JsonText, AStringThatSomebodyElseWroteIsUtf8) {
  EXPECT_EQ(parse_json("\"\\u20ac\"")->text, "\xE2\x82\xAC");
  EXPECT_EQ(parse_json("\"\\u0416\"")->text, "\xD0\x96");
}

RC_GTEST_PROP(JsonText, EveryByteSurvives, (const std::string& bytes)) {
  std::string text;
  append_json_string(text, bytes);
  const auto value = parse_json(text);
  RC_ASSERT(value.has_value());
  RC_ASSERT(value->text == bytes);
  for (const char letter : text) RC_ASSERT(letter >= ' ' && letter <= '~');
}

}  // namespace
}  // namespace kerf::base
