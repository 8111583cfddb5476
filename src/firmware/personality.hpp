#pragma once
// What one firmware does differently from another, as rows and named policies: everything the virtual controller asks
// about itself.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "common/base/time.hpp"
#include "common/vocabulary/firmware.hpp"

namespace kerf::firmware {

struct Personality;

/// The personality of a firmware; Grbl 1.1h for an unknown one.
[[nodiscard]] const Personality& personality_of(vocabulary::Firmware firmware);

/// The personality that people call `name` on a command line ("grbl", "rabbit", "grblhal"); null if there is none.
[[nodiscard]] const Personality* personality_named(std::string_view name);

/// All of them, in the order of vocabulary::Firmware.
[[nodiscard]] std::span<const Personality* const> all_personalities();

}  // namespace kerf::firmware
