#include "sender/session/record.hpp"

#include <array>
#include <cstddef>
#include <string_view>

namespace kerf::session {

std::string hash_of(std::string_view text) {
  constexpr std::uint64_t kOffsetBasis = 0xCBF29CE484222325;
  constexpr std::uint64_t kPrime = 0x100000001B3;
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  std::uint64_t hash = kOffsetBasis;
  for (const char byte : text) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  std::string digits(2 * sizeof hash, '0');
  for (std::size_t at = digits.size(); at-- > 0; hash >>= 4U) digits[at] = kHexDigits[hash & 0xFU];
  return digits;
}

}  // namespace kerf::session
