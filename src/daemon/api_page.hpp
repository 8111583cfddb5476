#pragma once
// The files of the page.

#include "io/web/http.hpp"

namespace kerf::daemon {

[[nodiscard]] io::web::HttpReply page_reply(const io::web::HttpRequest& request);

}  // namespace kerf::daemon
