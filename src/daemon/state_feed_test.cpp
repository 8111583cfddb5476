#include "daemon/state_feed.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace kerf::daemon {
namespace {

/// An object without nulls, at most `depth` deep.
Json object_by_chance(int depth) {
  Json object = Json::object();
  const int members = *rc::gen::inRange(0, 4);
  for (int at = 0; at < members; ++at) {
    const std::string name(1, static_cast<char>('a' + *rc::gen::inRange(0, 5)));
    switch (*rc::gen::inRange(0, depth > 0 ? 4 : 3)) {
      case 0: object[name] = *rc::gen::arbitrary<int>(); break;
      case 1: object[name] = *rc::gen::arbitrary<bool>(); break;
      case 2: object[name] = *rc::gen::arbitrary<std::vector<int>>(); break;
      default: object[name] = object_by_chance(depth - 1);
    }
  }
  return object;
}

bool are_same(const Json& one, const Json& other) {
  // The order of members means nothing.
  return nlohmann::json::parse(one.dump()) == nlohmann::json::parse(other.dump());
}

RC_GTEST_PROP(MergeDifference, MakesTheOneOfTheOther, ()) {
  const Json before = object_by_chance(3);
  const Json after = object_by_chance(3);
  Json patched = before;
  patched.merge_patch(merge_difference(before, after));
  RC_ASSERT(are_same(patched, after));
  RC_ASSERT(merge_difference(after, after).empty());
}

TEST(StateFeed, AClientThatAppliesEveryPatchHasTheState) {
  StateFeed feed;
  Json client = Json::object();
  for (int at = 0; at < 50; ++at) {
    feed.set("machines", at % 2 == 0 ? "a" : "b",
             at % 7 == 0 ? Json(nullptr) : Json{{"x", at}, {"y", {{"z", at / 3}}}});
    const Frame frame = feed.publish(at);
    if (frame == nullptr) continue;
    const Json patch = Json::parse(*frame);
    EXPECT_EQ(patch["number"], feed.number());
    client.merge_patch(patch["patch"]);
    EXPECT_TRUE(are_same(client, feed.state())) << client << feed.state();
  }
  EXPECT_EQ(feed.publish(99), nullptr);
}

TEST(StateFeed, GivesThePatchesSinceANumberOrNothing) {
  StateFeed feed;
  for (int at = 0; at < 1000; ++at) {
    feed.set("server", Json{{"x", at}});
    ASSERT_NE(feed.publish(0), nullptr);
  }
  EXPECT_EQ(feed.since(1000)->size(), 0U);
  ASSERT_EQ(feed.since(998)->size(), 2U);
  EXPECT_EQ(Json::parse(*feed.since(998)->front())["number"], 999);
  EXPECT_FALSE(feed.since(1).has_value());
  EXPECT_FALSE(feed.since(1001).has_value()) << "a number of an earlier daemon";
  EXPECT_EQ(Json::parse(*feed.snapshot(1))["number"], 1000);
}

}  // namespace
}  // namespace kerf::daemon
