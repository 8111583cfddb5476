#include "sender/streaming/solo_lines.hpp"

#include <cstddef>

#include "common/base/text.hpp"

namespace kerf::streaming {
namespace {

/// The number after a G word, without leading zeros and blanks: "G 028.1" gives "28.1".
std::string_view number_after(std::string_view text, std::size_t at) {
  while (at < text.size() && (text[at] == ' ' || text[at] == '0')) ++at;
  std::size_t end = at;
  while (end < text.size() && (base::is_digit(text[end]) || text[end] == '.')) ++end;
  return text.substr(at, end - at);
}

// `G10L20P1X0Y0`
bool writes_stored_offset(std::string_view text) {
  if (!text.contains('G') && !text.contains('g')) return false;  // most lines of a job
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '(' || text[at] == ';') return false;
    if (base::to_upper(text[at]) != 'G') continue;
    const std::string_view number = number_after(text, at + 1);
    if (number == "10" || number == "28.1" || number == "30.1") return true;
  }
  return false;
}

}  // namespace

bool must_travel_alone(std::string_view text, SoloPolicy policy) {
  if (policy == SoloPolicy::EveryLine) return true;
  if (!text.empty() && text.front() == '$') return true;
  return policy == SoloPolicy::StoredWritesToo && writes_stored_offset(text);
}

bool is_jog(std::string_view text) {
  return base::starts_with_ignoring_case(base::trim(text), "$J=");
}

}  // namespace kerf::streaming
