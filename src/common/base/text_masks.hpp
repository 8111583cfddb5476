#pragma once
// Where lines end and which bytes are no plain text, 64 bytes at a time: one bit for each byte, the first one lowest.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace kerf::base {

inline constexpr std::size_t kMaskedBytes = 64;

struct TextMasks {
  std::uint64_t line_feeds = 0;
  std::uint64_t carriage_returns = 0;
  /// Everything that a reader of G-code has to look at twice: control characters but tabs and line ends, `!`, `?`, `~`,
  /// bytes above 0x7E, and where a comment begins, `(` and `;`.
  std::uint64_t special = 0;
  bool operator==(const TextMasks&) const = default;
};

/// Eight bytes at a time, in the bits of one number, on any processor.
[[nodiscard]] inline TextMasks portable_text_masks(const char* bytes) {
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  constexpr std::uint64_t kHighs = 0x80U * kOnes;
  constexpr std::uint64_t kLows = 0x7FU * kOnes;
  const auto zeros = [](std::uint64_t word) { return ~(((word & kLows) + kLows) | word | kLows); };
  const auto bits_of = [](std::uint64_t highs) { return ((highs >> 7U) * 0x0102040810204080U) >> 56U; };
  TextMasks masks;
  for (std::size_t at = 0; at < kMaskedBytes; at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    for (std::size_t byte = 0; byte < sizeof word; ++byte) {
      word |= std::uint64_t{static_cast<unsigned char>(bytes[at + byte])} << (8U * byte);
    }
    const auto equal = [&](char letter) { return zeros(word ^ (kOnes * static_cast<unsigned char>(letter))); };
    const std::uint64_t feeds = equal('\n');
    const std::uint64_t returns = equal('\r');
    // Of seven bits: below a blank there is no carry into the eighth, above `}` there is one.
    const std::uint64_t below_blank = ~((word & kLows) + 0x60U * kOnes) & kHighs;
    const std::uint64_t above_brace = ((word & kLows) + 0x02U * kOnes) & kHighs;
    const std::uint64_t special = (below_blank & ~(feeds | returns | equal('\t'))) | above_brace | (word & kHighs) |
                                  equal('!') | equal('?') | equal('(') | equal(';');
    masks.line_feeds |= bits_of(feeds) << at;
    masks.carriage_returns |= bits_of(returns) << at;
    masks.special |= bits_of(special) << at;
  }
  return masks;
}

#ifdef __SSE2__
/// Sixteen bytes at a time.
[[nodiscard]] inline TextMasks text_masks(const char* bytes) {
  const auto bits_of = [](__m128i set) {
    return static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_epi8(set)));
  };
  TextMasks masks;
  for (std::size_t at = 0; at < kMaskedBytes; at += sizeof(__m128i)) {
    __m128i word;
    std::memcpy(&word, bytes + at, sizeof word);
    const auto equal = [word](char letter) { return _mm_cmpeq_epi8(word, _mm_set1_epi8(letter)); };
    const __m128i feeds = equal('\n');
    const __m128i returns = equal('\r');
    const __m128i ends = _mm_or_si128(_mm_or_si128(feeds, returns), equal('\t'));
    // Signed: bytes above 0x7F are below a blank.
    const __m128i below_blank = _mm_andnot_si128(ends, _mm_cmplt_epi8(word, _mm_set1_epi8(' ')));
    const __m128i above_brace = _mm_cmpgt_epi8(word, _mm_set1_epi8('}'));
    const __m128i marks = _mm_or_si128(_mm_or_si128(equal('!'), equal('?')), _mm_or_si128(equal('('), equal(';')));
    masks.line_feeds |= bits_of(feeds) << at;
    masks.carriage_returns |= bits_of(returns) << at;
    masks.special |= bits_of(_mm_or_si128(_mm_or_si128(below_blank, above_brace), marks)) << at;
  }
  return masks;
}
#else
[[nodiscard]] inline TextMasks text_masks(const char* bytes) {
  return portable_text_masks(bytes);
}
#endif

}  // namespace kerf::base
