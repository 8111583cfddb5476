#pragma once
// Where lines end and which bytes are no plain text, 64 bytes at a time: one bit for each byte, the first one lowest.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __x86_64__
#include <immintrin.h>
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

#ifdef __x86_64__
/// Two table look-ups by the halves of 32 bytes at once; a bit that both have names the class. For processors with
/// AVX2.
[[nodiscard, gnu::target("avx2")]] inline TextMasks avx2_text_masks(const char* bytes) {
  constexpr char kHigh = 1;     // 0x10..0x1F, 0x80..0xFF
  constexpr char kControl = 2;  // 0x00..0x0F but tab and line ends
  constexpr char kTop = 4;      // ~ and DEL
  constexpr char kMarks2 = 8;   // ! and (
  constexpr char kMarks3 = 16;  // ? and ;
  constexpr char kFeed = 32;
  constexpr char kReturn = 64;
  constexpr char kSpecial = kHigh | kControl | kTop | kMarks2 | kMarks3;
  constexpr char kAny = kHigh | kControl;
  const __m256i by_low = _mm256_broadcastsi128_si256(
      _mm_setr_epi8(kAny, kAny | kMarks2, kAny, kAny, kAny, kAny, kAny, kAny, kAny | kMarks2, kHigh, kHigh | kFeed,
                    kAny | kMarks3, kAny, kHigh | kReturn, kAny | kTop, kAny | kTop | kMarks3));
  const __m256i by_high =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(kControl | kFeed | kReturn, kHigh, kMarks2, kMarks3, 0, 0, 0, kTop,
                                                kHigh, kHigh, kHigh, kHigh, kHigh, kHigh, kHigh, kHigh));
  const __m256i half = _mm256_set1_epi8(0x0F);
  const auto bits_of = [](__m256i set) __attribute__((target("avx2"))) {
    return std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_epi8(set))};
  };
  TextMasks masks;
  for (std::size_t at = 0; at < kMaskedBytes; at += sizeof(__m256i)) {
    __m256i word;
    std::memcpy(&word, bytes + at, sizeof word);
    const __m256i low = _mm256_shuffle_epi8(by_low, _mm256_and_si256(word, half));
    const __m256i high = _mm256_shuffle_epi8(by_high, _mm256_and_si256(_mm256_srli_epi16(word, 4), half));
    const __m256i classes = _mm256_and_si256(low, high);
    const __m256i plain =
        _mm256_cmpeq_epi8(_mm256_and_si256(classes, _mm256_set1_epi8(kSpecial)), _mm256_setzero_si256());
    masks.line_feeds |= bits_of(_mm256_cmpeq_epi8(classes, _mm256_set1_epi8(kFeed))) << at;
    masks.carriage_returns |= bits_of(_mm256_cmpeq_epi8(classes, _mm256_set1_epi8(kReturn))) << at;
    masks.special |= (bits_of(plain) ^ 0xFFFF'FFFFU) << at;
  }
  return masks;
}
#endif

using TextMaskMaker = TextMasks (*)(const char* bytes);

/// What this processor does fastest.
[[nodiscard]] inline TextMaskMaker fastest_text_masks() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") != 0) return &avx2_text_masks;
#endif
  return &portable_text_masks;
}

}  // namespace kerf::base
