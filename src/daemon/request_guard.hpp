#pragma once
// Who may ask: browsers keep foreign pages from reading answers, not from sending requests, and a name that anybody
// can point at this computer (DNS rebinding) makes a foreign page look like ours.

#include <optional>
#include <string_view>

#include "io/web/http.hpp"

namespace kerf::daemon {

/// The refusal of a request that is not for us or not from us; nothing where it may go on. `changes`: it is more than
/// reading.
[[nodiscard]] std::optional<io::web::HttpReply> why_refused(const io::web::HttpRequest& request, bool changes);

/// "localhost", "127.0.0.1", "[::1]", with or without a port.
[[nodiscard]] bool is_loopback_host(std::string_view host);

}  // namespace kerf::daemon
