#pragma once
// A message to the line that a controller prints for it. The inverse of `decode`, to the printed precision.

#include <span>
#include <string>

#include "common/protocol/message.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/status_fields.hpp"

namespace kerf::protocol {

/// How one firmware prints numbers, and in which order the fields of a status report come.
struct PrintStyle {
  int position_decimals = 3;
  int feed_decimals = 0;
  int rpm_decimals = 0;
  bool speed_has_trailing_dot = false;
  std::span<const vocabulary::StatusField> field_order = vocabulary::grblhal_field_order();
};

/// The style of `dialect`, with `$13` (report in inches) as given.
[[nodiscard]] PrintStyle style_of(const vocabulary::Dialect& dialect, bool inches = false);

/// The line for `message`, without line ends. Texts are printed as they are: keep line ends out of them.
[[nodiscard]] std::string encode(const Message& message, const PrintStyle& style = {});

/// `S0.` or `S0`: a spindle speed as a word of `[GC:]`.
[[nodiscard]] std::string speed_word(double rpm, const PrintStyle& style);

/// "0.000,1.000": values in axis order.
[[nodiscard]] std::string print_positions(std::span<const double> values, const PrintStyle& style);

}  // namespace kerf::protocol
