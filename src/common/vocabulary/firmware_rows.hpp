#pragma once
// The rows of a table that one firmware knows, picked at compile time.

#include <algorithm>
#include <array>
#include <cstddef>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary::tables {

/// The rows of `Rows` whose `known_to` contains `Wanted`, in the same order.
template <const auto& Rows, Firmware Wanted>
inline constexpr auto kRowsOf = [] {
  constexpr auto kIsWanted = [](const auto& row) { return contains(row.known_to, Wanted); };
  constexpr std::size_t kCount = static_cast<std::size_t>(std::ranges::count_if(Rows, kIsWanted));
  std::array<typename std::remove_cvref_t<decltype(Rows)>::value_type, kCount> rows{};
  std::ranges::copy_if(Rows, rows.begin(), kIsWanted);
  return rows;
}();

}  // namespace kerf::vocabulary::tables
