#include "common/base/text_masks.hpp"

#include <array>
#include <cstdint>
#include <string_view>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::base {
namespace {

bool is_special(unsigned char byte) {
  if (byte == '\n' || byte == '\r' || byte == '\t') return false;
  return byte < ' ' || byte >= '~' || std::string_view{"!?(;"}.contains(static_cast<char>(byte));
}

TextMasks one_by_one(const std::array<char, kMaskedBytes>& bytes) {
  TextMasks masks;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const std::uint64_t bit = std::uint64_t{1} << at;
    if (bytes[at] == '\n') masks.line_feeds |= bit;
    if (bytes[at] == '\r') masks.carriage_returns |= bit;
    if (is_special(static_cast<unsigned char>(bytes[at]))) masks.special |= bit;
  }
  return masks;
}

TEST(TextMasks, KnowEveryByte) {
  for (unsigned start = 0; start < 256; start += kMaskedBytes) {
    std::array<char, kMaskedBytes> bytes{};
    for (unsigned at = 0; at < kMaskedBytes; ++at) bytes[at] = static_cast<char>(start + at);
    EXPECT_EQ(fastest_text_masks()(bytes.data()), one_by_one(bytes)) << start;
    EXPECT_EQ(portable_text_masks(bytes.data()), one_by_one(bytes)) << start;
  }
}

RC_GTEST_PROP(TextMasks, AreTheSameHoweverTheyAreMade, (std::uint64_t seed)) {
  std::array<char, kMaskedBytes> bytes{};
  for (char& byte : bytes) {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    byte = static_cast<char>(seed >> 56U);
  }
  RC_ASSERT(fastest_text_masks()(bytes.data()) == one_by_one(bytes));
  RC_ASSERT(portable_text_masks(bytes.data()) == one_by_one(bytes));
}

}  // namespace
}  // namespace kerf::base
