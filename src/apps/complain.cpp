#include <cstdio>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"

namespace kerf::apps {

void complain(const std::string& sentence) {
  std::fflush(stdout);
  put_to(stderr, "kerf: {}\n", sentence);
}

}  // namespace kerf::apps
