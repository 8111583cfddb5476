#include "common/base/content_hash.hpp"

#include <cstddef>

// Compiled into this file: nothing is linked.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace kerf::base {

namespace {

std::string digits_of(XXH128_hash_t hash) {
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, hash);
  std::string digits;
  digits.reserve(2 * sizeof canonical.digest);
  for (const unsigned char byte : canonical.digest) {
    digits += kHexDigits[byte >> 4U];
    digits += kHexDigits[byte & 0xFU];
  }
  return digits;
}

}  // namespace

struct ContentHash::State {
  XXH3_state_t hash;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->hash);
}
ContentHash::~ContentHash() = default;
ContentHash::ContentHash(ContentHash&&) noexcept = default;
ContentHash& ContentHash::operator=(ContentHash&&) noexcept = default;

void ContentHash::add(std::string_view piece) {
  XXH3_128bits_update(&state_->hash, piece.data(), piece.size());
}

std::string ContentHash::digits() const {
  return digits_of(XXH3_128bits_digest(&state_->hash));
}

std::string content_hash(std::string_view bytes) {
  return digits_of(XXH3_128bits(bytes.data(), bytes.size()));
}

}  // namespace kerf::base
