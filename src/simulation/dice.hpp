#pragma once
// Seeded chance: the same seed gives the same draws on every computer.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>

#include "common/base/time.hpp"

namespace kerf::simulation {

/// std::mt19937_64 is the same everywhere; the distributions of the standard library are not, so the draws are made
/// here.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}

  /// 0 up to but without `limit`, which is at least 1.
  std::uint64_t below(std::uint64_t limit) { return random_() % limit; }
  /// Both ends included.
  int between(int least, int most) {
    return least + static_cast<int>(below(static_cast<std::uint64_t>(most - least) + 1));
  }
  bool one_in(unsigned times) { return below(times) == 0; }
  /// 0 up to but without 1.
  double share() { return static_cast<double>(random_() >> 11U) * 0x1.0p-53; }
  double within(double least, double most) { return least + (most - least) * share(); }
  Duration up_to(Duration most) {
    return Duration{static_cast<Duration::rep>(share() * static_cast<double>(most.count()))};
  }
  template <class Value>
  Value pick(std::initializer_list<Value> values) {
    return *(values.begin() + static_cast<std::ptrdiff_t>(below(values.size())));
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace kerf::simulation
