#pragma once
// The letters of `A:` (what is switched on) (protocol.md 3.3).

#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// One letter of `A:`.
struct AccessoryRow {
  char letter{};
  std::string_view name;
  std::string_view text;
  FirmwareSet known_to{};
  friend constexpr bool operator==(const AccessoryRow&, const AccessoryRow&) = default;
};
BOOST_DESCRIBE_STRUCT(AccessoryRow, (), (letter, name, text, known_to))

[[nodiscard]] std::span<const AccessoryRow> accessory_rows();
[[nodiscard]] const AccessoryRow* find_accessory(Firmware firmware, char letter);

}  // namespace kerf::vocabulary
