#pragma once
// The text that most lines consist of, which every firmware reads as it stands.

#include <array>
#include <string_view>

namespace kerf::gcode {

/// Capitals, digits and what belongs to a number: nothing that a firmware strips, turns or takes for more than a word.
inline constexpr std::array<bool, 256> kIsPlain = [] {
  std::array<bool, 256> plain{};
  for (const char letter : std::string_view{"ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-+"}) {
    plain[static_cast<unsigned char>(letter)] = true;
  }
  return plain;
}();

[[nodiscard]] inline bool is_plain(std::string_view text) {
  bool plain = true;
  for (const char letter : text) plain &= kIsPlain[static_cast<unsigned char>(letter)];
  return plain;
}

}  // namespace kerf::gcode
