// How much memory one virtual controller holds: on the heap, while it rests with settings read, and with its planner
// full.

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <malloc.h>

#include "firmware/personality.hpp"
#include "firmware/rig.hpp"
#include "firmware/virtual_controller.hpp"

namespace {

using kerf::Instant;
using kerf::firmware::Rig;

/// What the issue allows, bytes.
constexpr double kMostBytes = 5e6;

std::size_t heap_bytes() {
  const auto counts = ::mallinfo2();
  return counts.uordblks + counts.hblkhd;
}

/// Lists what it has, then takes more lines than its planner holds and is in the middle of them.
void work(Rig& rig) {
  rig.on_bytes(Instant{}, "$$\n$#\n$G\nG21G91G1F100\n");
  for (int line = 0; line < 400; ++line) {
    rig.on_bytes(Instant{}, line % 2 == 0 ? "X0.1\n" : "X-0.1\n");
    static_cast<void>(rig.take_outbox());
  }
}

double bytes_each(const kerf::firmware::Personality& personality, std::size_t count, bool works) {
  const std::size_t before = heap_bytes();
  std::vector<Rig> rigs;
  rigs.reserve(count);
  for (std::size_t index = 0; index < count; ++index) {
    rigs.emplace_back(kerf::firmware::VirtualController(personality));
    rigs.back().power_on(Instant{});
    static_cast<void>(rigs.back().take_outbox());
    if (works) work(rigs.back());
  }
  return static_cast<double>(heap_bytes() - before) / static_cast<double>(count);
}

}  // namespace

int main() {
  bool fits = true;
  for (const auto* personality : kerf::firmware::all_personalities()) {
    for (const std::size_t count : {1U, 10U, 100U}) {
      const double rest = bytes_each(*personality, count, false);
      const double work = bytes_each(*personality, count, true);
      std::printf("%-12s %3zu controllers: %7.1f kB each at rest, %7.1f kB each with a full planner\n",
                  std::string(personality->dialect().name).c_str(), count, rest / 1e3, work / 1e3);
      fits = fits && work <= kMostBytes;
    }
  }
  return fits ? EXIT_SUCCESS : EXIT_FAILURE;
}
