#include "daemon/request_guard.hpp"

#include <gtest/gtest.h>

namespace kerf::daemon {
namespace {

int status_of(const std::string& host, const std::string& origin, bool changes) {
  io::web::HttpRequest request;
  request.headers["host"] = host;
  if (!origin.empty()) request.headers["origin"] = origin;
  const auto refusal = why_refused(request, changes);
  return refusal ? refusal->status : 200;
}

TEST(RequestGuard, KnowsItsOwnNames) {
  for (const char* const host : {"localhost", "localhost:8080", "127.0.0.1:1", "[::1]:8080", "[::1]"}) {
    EXPECT_TRUE(is_loopback_host(host)) << host;
  }
  for (const char* const host : {"", "localhost.evil.com", "localhost:", "localhost:80x", "127.0.0.1.nip.io",
                                 "evil.com", "0.0.0.0:80", "127.0.0.12"}) {
    EXPECT_FALSE(is_loopback_host(host)) << host;
  }
}

TEST(RequestGuard, RefusesForeignNamesAndForeignPages) {
  EXPECT_EQ(status_of("localhost:8080", "", true), 200);
  EXPECT_EQ(status_of("localhost:8080", "http://localhost:8080", true), 200);
  EXPECT_EQ(status_of("localhost:8080", "http://localhost:9999", true), 403) << "another server on this computer";
  EXPECT_EQ(status_of("localhost:8080", "http://evil.com", true), 403);
  EXPECT_EQ(status_of("localhost:8080", "null", true), 403);
  EXPECT_EQ(status_of("evil.com", "", false), 403) << "a name that somebody points here";
  EXPECT_EQ(status_of("localhost:8080", "http://evil.com", false), 200) << "its browser keeps the answer from it";
}

}  // namespace
}  // namespace kerf::daemon
