#pragma once
// What `$I` says about a build: the letters of `[OPT:]`, the tokens of `[NEWOPT:]` (protocol.md 4.5, 4.6).

#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// One letter of `[OPT:`. `L` and `2` mean something else on each firmware, so a letter may have several rows.
struct OptionRow {
  char letter{};
  std::string_view name;
  std::string_view text;
  FirmwareSet known_to{};
  friend constexpr bool operator==(const OptionRow&, const OptionRow&) = default;
};
BOOST_DESCRIBE_STRUCT(OptionRow, (), (letter, name, text, known_to))

[[nodiscard]] std::span<const OptionRow> option_rows();
[[nodiscard]] const OptionRow* find_option(Firmware firmware, char letter);

/// One token of grblHAL's `[NEWOPT:`.
struct NewOptionRow {
  std::string_view token;  ///< without the value
  std::string_view name;
  std::string_view text;
  bool takes_value = false;  ///< `ATC=1`
  bool plugin = false;       ///< added by a plugin or a driver, not by the core
  friend constexpr bool operator==(const NewOptionRow&, const NewOptionRow&) = default;
};
BOOST_DESCRIBE_STRUCT(NewOptionRow, (), (token, name, text, takes_value, plugin))

[[nodiscard]] std::span<const NewOptionRow> new_option_rows();
/// The row for a token as received; a `=value` behind it is ignored.
[[nodiscard]] const NewOptionRow* find_new_option(std::string_view token);

}  // namespace kerf::vocabulary
