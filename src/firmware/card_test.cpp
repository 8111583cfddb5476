#include "firmware/card.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::firmware {
namespace {

TEST(CardPath, IsPlainAndNeverLeavesTheCard) {
  EXPECT_EQ(card_path("/", "a.nc"), "/a.nc");
  EXPECT_EQ(card_path("/jobs", "a.nc"), "/jobs/a.nc");
  EXPECT_EQ(card_path("/jobs", "/a.nc"), "/a.nc");
  EXPECT_EQ(card_path("/jobs", ".."), "/");
  EXPECT_EQ(card_path("/", "../../etc/passwd"), "/etc/passwd");
  EXPECT_EQ(card_path("/", "jobs//./x/../a.nc"), "/jobs/a.nc");
  EXPECT_EQ(card_path("/jobs", ""), "/jobs");
  rc::check("no way up", [](const std::string& folder, const std::string& name) {
    const std::string path = card_path(folder, name);
    RC_ASSERT(path.starts_with('/'));
    RC_ASSERT((path + "/").find("/../") == std::string::npos);
    RC_ASSERT(card_path("/", path) == path);
  });
}

TEST(MemoryCard, FoldersAreMadeOfTheirFiles) {
  MemoryCard card;
  card.put("b.nc", "12");
  card.put("/jobs/a.nc", "1");
  EXPECT_EQ(*card.list("/"), (std::vector<CardEntry>{{.name = "b.nc", .bytes = 2, .is_folder = false},
                                                     {.name = "jobs", .bytes = 0, .is_folder = true}}));
  EXPECT_EQ(card.list("/jobs")->size(), 1U);
  EXPECT_FALSE(card.list("/nope").has_value());
  EXPECT_TRUE(card.find("/jobs")->is_folder);
  EXPECT_EQ(card.find("/jobs/a.nc")->bytes, 1U);
  EXPECT_FALSE(card.create("/jobs"));
}

TEST(MemoryCard, FilesAreWrittenPieceByPiece) {
  MemoryCard card;
  EXPECT_FALSE(card.append("/a", "x"));
  ASSERT_TRUE(card.create("/a"));
  ASSERT_TRUE(card.append("/a", "hello "));
  ASSERT_TRUE(card.append("/a", "world"));
  EXPECT_EQ(card.read("/a", 6, 3), "wor");
  EXPECT_EQ(card.read("/a", 11, 3), "");
  EXPECT_TRUE(card.remove("/a"));
  EXPECT_FALSE(card.remove("/a"));
  EXPECT_FALSE(card.contents("/a").has_value());
}

}  // namespace
}  // namespace kerf::firmware
