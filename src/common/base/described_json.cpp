#include "common/base/described_json.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string_view>

namespace kerf::base::described {
namespace {

constexpr std::int64_t kNanosecondsASecond = 1'000'000'000;
constexpr std::size_t kSecondDecimals = 9;

}  // namespace

void write(std::string& out, Instant value) {
  const std::int64_t count = value.time_since_epoch().count();
  const std::string fraction = std::to_string(std::abs(count % kNanosecondsASecond));
  if (count < 0) out += '-';
  out += std::to_string(std::abs(count / kNanosecondsASecond)) + '.';
  out.append(kSecondDecimals - fraction.size(), '0');
  out += fraction;
}

bool read(const JsonValue& json, Instant& value) {
  if (json.kind != JsonValue::Kind::Number) return false;
  std::string_view text = json.text;
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  const std::size_t point = std::min(text.find('.'), text.size());
  const auto seconds = parse_int<std::int64_t>(text.substr(0, point));
  std::string decimals(text.substr(std::min(point + 1, text.size())));
  if (decimals.size() > kSecondDecimals) return false;
  decimals.append(kSecondDecimals - decimals.size(), '0');
  const auto nanoseconds = parse_int<std::int64_t>(decimals);
  constexpr std::int64_t kMostSeconds = 9'000'000'000;
  if (!seconds || *seconds < 0 || *seconds > kMostSeconds || !nanoseconds || *nanoseconds < 0) return false;
  const Duration since{*seconds * kNanosecondsASecond + *nanoseconds};
  value = Instant{is_negative ? -since : since};
  return true;
}

}  // namespace kerf::base::described
