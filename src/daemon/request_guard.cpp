#include "daemon/request_guard.hpp"

#include <algorithm>
#include <array>

#include "daemon/api_replies.hpp"

namespace kerf::daemon {

bool is_loopback_host(std::string_view host) {
  constexpr std::array<std::string_view, 3> kNames{"localhost", "127.0.0.1", "[::1]"};
  return std::ranges::any_of(kNames, [&](std::string_view name) {
    if (!host.starts_with(name)) return false;
    const std::string_view rest = host.substr(name.size());
    return rest.empty() || (rest.size() > 1 && rest.front() == ':' &&
                            rest.find_first_not_of("0123456789", 1) == std::string_view::npos);
  });
}

std::optional<io::web::HttpReply> why_refused(const io::web::HttpRequest& request, bool changes) {
  const std::string_view host = request.header("host");
  if (!is_loopback_host(host)) {
    return error_reply(403, "ForeignHost", "This daemon answers only as localhost.");
  }
  const std::string_view origin = request.header("origin");
  const bool is_ours = origin.empty() || (origin.starts_with("http://") && origin.substr(7) == host);
  if (changes && !is_ours) return error_reply(403, "ForeignOrigin", "Another page may not ask for this.");
  return std::nullopt;
}

}  // namespace kerf::daemon
