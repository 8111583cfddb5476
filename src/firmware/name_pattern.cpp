#include "firmware/name_pattern.hpp"

#include "common/base/text.hpp"

namespace kerf::firmware {

namespace {

bool starts_with_pattern(std::string_view pattern, std::string_view text);

bool contains_pattern(std::string_view pattern, std::string_view text) {
  for (std::size_t at = 0; at <= text.size(); ++at) {
    if (starts_with_pattern(pattern, text.substr(at))) return true;
  }
  return false;
}

bool starts_with_pattern(std::string_view pattern, std::string_view text) {
  while (!pattern.empty()) {
    if (pattern.front() == '*') return contains_pattern(pattern.substr(1), text);
    if (pattern == "$") return text.empty();
    if (text.empty() || base::to_upper(text.front()) != base::to_upper(pattern.front())) return false;
    pattern.remove_prefix(1);
    text.remove_prefix(1);
  }
  return true;
}

}  // namespace

bool matches_pattern(std::string_view pattern, std::string_view name) {
  if (pattern.starts_with('^')) return starts_with_pattern(pattern.substr(1), name);
  return contains_pattern(pattern, name);
}

}  // namespace kerf::firmware
