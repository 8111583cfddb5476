#include "common/base/content_hash.hpp"

#include <cstddef>

// Compiled into this file: nothing is linked.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace kerf::base {

std::string content_hash(std::string_view bytes) {
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::string digits;
  digits.reserve(2 * sizeof canonical.digest);
  for (const unsigned char byte : canonical.digest) {
    digits += kHexDigits[byte >> 4U];
    digits += kHexDigits[byte & 0xFU];
  }
  return digits;
}

}  // namespace kerf::base
