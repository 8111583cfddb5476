#pragma once
// The wires of a controller.

#include <cstddef>
#include <cstdint>

namespace kerf::firmware {

/// `Pendant` is grblHAL's second stream (MPG); only where one is fitted does anything come or go there.
enum class Port : std::uint8_t { Main, Pendant };
inline constexpr std::size_t kPorts = 2;

}  // namespace kerf::firmware
