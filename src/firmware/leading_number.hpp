#pragma once
// A number at the start of a text, as the firmwares' read_float takes it.

#include <optional>
#include <string_view>

namespace kerf::firmware {

/// The number at the start of a text, and what follows it (gnea/grbl nuts_bolts.c read_float: sign, digits, one point).
struct LeadingNumber {
  float value = 0;
  std::string_view rest;
};

[[nodiscard]] std::optional<LeadingNumber> leading_number(std::string_view text);

}  // namespace kerf::firmware
