#include "io/web/http.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

namespace kerf::io::web {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(RequestTarget, HasPathAndParameters) {
  const auto target = parse_target("/api/v1/programs?name=my%20part+1.nc&count=5&flag");
  ASSERT_TRUE(target.has_value());
  EXPECT_EQ(target->path, "/api/v1/programs");
  EXPECT_THAT(target->query, ElementsAre(Pair("count", "5"), Pair("flag", ""), Pair("name", "my part 1.nc")));
}

TEST(RequestTarget, NeverLeavesTheRoot) {
  for (const char* const target : {"", "x", "http://a/b", "/../etc/passwd", "/a/..", "/a/%2e%2e/b", "/a/%2E./b",
                                   "/..%2fetc", "/a%00b", "/%", "/%1", "/%zz", "/a\\..\\b", "/%5c..", "/a?x=%"}) {
    EXPECT_FALSE(parse_target(target).has_value()) << target;
  }
  EXPECT_TRUE(parse_target("/a..b/...").has_value());
}

RC_GTEST_PROP(RequestTarget, OfAnyBytesStaysWithin, (const std::string& text)) {
  const auto target = parse_target("/" + text);
  if (!target) return;
  RC_ASSERT(target->path.starts_with('/'));
  RC_ASSERT(!(target->path + "/").contains("/../"));
  RC_ASSERT(!target->path.contains('\0') || text.contains('\0'));
}

}  // namespace
}  // namespace kerf::io::web
