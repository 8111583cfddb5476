#include "io/web/http.hpp"

#include <algorithm>
#include <charconv>

namespace kerf::io::web {
namespace {

bool leaves_root(std::string_view path) {
  for (std::size_t at = 0; at < path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    if (path.substr(at, end - at) == "..") return true;
    at = end + 1;
  }
  return false;
}

bool parse_query(std::string_view text, std::map<std::string, std::string>& into) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('&', at), text.size());
    const std::string_view pair = text.substr(at, end - at);
    const std::size_t equals = std::min(pair.find('='), pair.size());
    auto name = decode_percent(pair.substr(0, equals), true);
    auto value = decode_percent(pair.substr(std::min(equals + 1, pair.size())), true);
    if (!name || !value) return false;
    if (!name->empty()) into[*std::move(name)] = *std::move(value);
    at = end + 1;
  }
  return true;
}

}  // namespace

std::string_view HttpRequest::header(const std::string& lower_case_name) const {
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? std::string_view{} : found->second;
}

std::optional<std::string> HttpRequest::parameter(const std::string& name) const {
  const auto found = query.find(name);
  if (found == query.end()) return std::nullopt;
  return found->second;
}

std::optional<std::string> decode_percent(std::string_view text, bool plus_is_blank) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '+' && plus_is_blank) {
      decoded += ' ';
    } else if (text[at] == '%') {
      constexpr std::size_t kDigits = 2;
      unsigned value = 0;
      if (text.size() - at <= kDigits) return std::nullopt;
      const char* const first = text.data() + at + 1;
      const auto [end, fault] = std::from_chars(first, first + kDigits, value, 16);
      if (fault != std::errc{} || end != first + kDigits || value == 0) return std::nullopt;
      decoded += static_cast<char>(value);
      at += kDigits;
    } else {
      decoded += text[at];
    }
  }
  return decoded;
}

std::optional<RequestTarget> parse_target(std::string_view target) {
  const std::size_t mark = std::min(target.find('?'), target.size());
  auto path = decode_percent(target.substr(0, mark));
  if (!path || !path->starts_with('/') || leaves_root(*path) || path->contains('\\')) return std::nullopt;
  RequestTarget parsed{.path = *std::move(path), .query = {}};
  if (!parse_query(target.substr(std::min(mark + 1, target.size())), parsed.query)) return std::nullopt;
  return parsed;
}

}  // namespace kerf::io::web
