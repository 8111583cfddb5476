#include <cstdio>

#include <fmt/format.h>

#include "apps/commands.hpp"

namespace kerf::apps {

void complain(const std::string& sentence) {
  std::fflush(stdout);
  fmt::print(stderr, "kerf: {}\n", sentence);
}

}  // namespace kerf::apps
