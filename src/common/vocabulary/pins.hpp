#pragma once
// The letters of `Pn:` (inputs that are active) and of grblHAL's `[SIGNALS:]` (protocol.md 3.3).

#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// One letter of `Pn:`.
struct PinRow {
  char letter{};
  std::string_view name;
  std::string_view text;
  FirmwareSet known_to{};
  friend constexpr bool operator==(const PinRow&, const PinRow&) = default;
};
BOOST_DESCRIBE_STRUCT(PinRow, (), (letter, name, text, known_to))

[[nodiscard]] std::span<const PinRow> pin_rows();
/// The sense of `letter` on `firmware`; on an unknown one that of the first row that fits.
[[nodiscard]] const PinRow* find_pin(Firmware firmware, char letter);

}  // namespace kerf::vocabulary
