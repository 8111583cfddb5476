#include "common/base/content_hash.hpp"

#include <gtest/gtest.h>

namespace kerf::base {
namespace {

// XXH3_128bits of nothing, as the xxHash specification gives it.
TEST(ContentHash, OfNothingIsThatOfTheSpecification) {
  EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");
}

TEST(ContentHash, TellsOneByteFromAnother) {
  const std::string text(100'000, 'x');
  std::string other = text;
  other[50'000] = 'y';
  EXPECT_NE(content_hash(text), content_hash(other));
  EXPECT_EQ(content_hash(text), content_hash(std::string(100'000, 'x')));
  EXPECT_EQ(content_hash(text).size(), 32U);
}

TEST(ContentHash, IsTheSameInPieces) {
  std::string text;
  for (int line = 0; line < 1000; ++line) text += "G1X" + std::to_string(line) + "\n";
  for (const std::size_t piece : {std::size_t{1}, std::size_t{100}, std::size_t{4096}, text.size()}) {
    ContentHash hash;
    for (std::size_t at = 0; at < text.size(); at += piece) hash.add(std::string_view{text}.substr(at, piece));
    EXPECT_EQ(hash.digits(), content_hash(text));
  }
  EXPECT_EQ(ContentHash().digits(), content_hash(""));
}

}  // namespace
}  // namespace kerf::base
