#include "firmware/leading_number.hpp"

#include "common/base/text.hpp"

namespace kerf::firmware {

std::optional<LeadingNumber> leading_number(std::string_view text) {
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  std::size_t length = digits.starts_with('-') ? 1 : 0;
  bool has_point = false;
  while (length < digits.size() && (base::is_digit(digits[length]) || (digits[length] == '.' && !has_point))) {
    has_point = has_point || digits[length] == '.';
    ++length;
  }
  const auto value = base::parse_decimal(digits.substr(0, length));
  if (!value) return std::nullopt;
  return LeadingNumber{.value = static_cast<float>(*value), .rest = digits.substr(length)};
}

}  // namespace kerf::firmware
