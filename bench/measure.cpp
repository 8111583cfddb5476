#include "measure.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>

namespace kerf::bench {
namespace {

double thread_cpu_s() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  constexpr double kNanosecond = 1e-9;
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * kNanosecond;
}

}  // namespace

Took time(const std::function<void()>& work) {
  const auto wall_before = std::chrono::steady_clock::now();
  const double cpu_before = thread_cpu_s();
  work();
  const double cpu_s = thread_cpu_s() - cpu_before;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_before;
  return {.cpu_s = cpu_s, .wall_s = wall.count()};
}

Middle middle_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {.median = values[values.size() / 2], .least = values.front(), .most = values.back()};
}

Took time_yardstick() {
  constexpr int kRounds = 40'000'000;
  volatile std::uint64_t kept = 0;
  return time([&kept] {
    std::uint64_t state = 1;
    for (int i = 0; i < kRounds; ++i) state = state * 6364136223846793005U + 1442695040888963407U;
    kept = state;
  });
}

}  // namespace kerf::bench
