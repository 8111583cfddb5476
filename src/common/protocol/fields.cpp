#include "common/protocol/fields.hpp"

#include "common/base/text.hpp"

namespace kerf::protocol {

std::optional<std::string_view> between(std::string_view line, std::string_view prefix, std::string_view suffix) {
  if (line.size() < prefix.size() + suffix.size()) return std::nullopt;
  if (!line.starts_with(prefix) || !line.ends_with(suffix)) return std::nullopt;
  return line.substr(prefix.size(), line.size() - prefix.size() - suffix.size());
}

std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view part : base::split(text, ',')) {
    const std::optional<double> number = base::parse_decimal(part);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<bool> flag_of(std::string_view text) {
  if (text == "0") return false;
  if (text == "1") return true;
  return std::nullopt;
}

}  // namespace kerf::protocol
