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

}  // namespace
}  // namespace kerf::base
