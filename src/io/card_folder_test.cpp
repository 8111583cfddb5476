#include "io/card_folder.hpp"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace kerf::io {
namespace {

namespace fs = std::filesystem;

class CardFolderTest : public ::testing::Test {
 protected:
  CardFolderTest() {
    std::string pattern = (fs::temp_directory_path() / "kerf-card-XXXXXX").string();
    base = mkdtemp(pattern.data());
    fs::create_directories(base / "card" / "jobs");
    put("card/a.nc", "G21\n");
    put("card/jobs/b.nc", "G0X1\n");
    put("card/.hidden.nc", "G0X1\n");
    put("secret.nc", "G0X1\n");
    fs::create_symlink(base / "secret.nc", base / "card" / "way_out.nc");
  }
  ~CardFolderTest() override { fs::remove_all(base); }
  CardFolderTest(const CardFolderTest&) = delete;
  CardFolderTest& operator=(const CardFolderTest&) = delete;

  void put(const std::string& name, const std::string& text) const { std::ofstream(base / name) << text; }

  fs::path base;
};

TEST_F(CardFolderTest, ListsWhatIsInsideAndVisible) {
  CardFolder card(base / "card");
  EXPECT_EQ(*card.list("/"), (std::vector<firmware::CardEntry>{{.name = "a.nc", .bytes = 4, .is_folder = false},
                                                               {.name = "jobs", .bytes = 0, .is_folder = true}}));
  EXPECT_EQ(card.list("/jobs")->size(), 1U);
  EXPECT_FALSE(card.list("/nowhere").has_value());
  EXPECT_FALSE(card.list("/a.nc").has_value());
}

TEST_F(CardFolderTest, NothingOutsideIsReached) {
  CardFolder card(base / "card");
  EXPECT_FALSE(card.find("/way_out.nc").has_value());
  EXPECT_EQ(card.read("/way_out.nc", 0, 10), "");
  EXPECT_FALSE(card.create("/way_out.nc"));
  EXPECT_FALSE(card.remove("/way_out.nc"));
  EXPECT_FALSE(card.find("/../secret.nc").has_value());
  EXPECT_FALSE(card.find("/.hidden.nc").has_value());
  EXPECT_FALSE(card.remove("/jobs"));
  EXPECT_TRUE(fs::exists(base / "secret.nc"));
}

TEST_F(CardFolderTest, ReadsAndWrites) {
  CardFolder card(base / "card");
  EXPECT_EQ(card.read("/jobs/b.nc", 2, 2), "X1");
  EXPECT_EQ(card.read("/jobs/b.nc", 5, 2), "");
  ASSERT_TRUE(card.create("/jobs/new.nc"));
  ASSERT_TRUE(card.append("/jobs/new.nc", "G0"));
  ASSERT_TRUE(card.append("/jobs/new.nc", "X2"));
  EXPECT_EQ(card.find("/jobs/new.nc")->bytes, 4U);
  EXPECT_FALSE(card.create("/nowhere/new.nc"));
  EXPECT_FALSE(card.create("/jobs"));
  EXPECT_TRUE(card.remove("/jobs/new.nc"));
  EXPECT_FALSE(card.remove("/jobs/new.nc"));
}

}  // namespace
}  // namespace kerf::io
