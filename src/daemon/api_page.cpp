#include "daemon/api_page.hpp"

#include <algorithm>

#include "daemon/api_replies.hpp"
#include "daemon/page_files.hpp"

namespace kerf::daemon {
namespace {

/// Nothing from anywhere else, and in nobody's frame.
constexpr const char* kPolicy =
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; worker-src 'self' blob:; "
    "connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

}  // namespace

io::web::HttpReply page_reply(const io::web::HttpRequest& request) {
  if (request.method != "GET" && request.method != "HEAD") {
    return error_reply(405, "NotAllowed", "The page can only be read.");
  }
  const std::string_view path = request.path == "/" ? "/index.html" : std::string_view{request.path};
  const auto files = page_files();
  const auto file = std::ranges::find(files, path, &PageFile::path);
  if (file == files.end()) return error_reply(404, "NotFound", "There is nothing at this address.");
  io::web::HttpReply reply{.content_type = std::string(file->content_type)};
  const bool is_named_by_content = path.starts_with("/assets/");
  reply.headers = {{"ETag", std::string(file->etag)},
                   {"Cache-Control", is_named_by_content ? "public, max-age=31536000, immutable" : "no-cache"},
                   {"X-Content-Type-Options", "nosniff"},
                   {"Referrer-Policy", "no-referrer"},
                   {"Content-Security-Policy", kPolicy},
                   {"Vary", "Accept-Encoding"}};
  if (request.header("if-none-match") == file->etag) {
    reply.status = 304;
    return reply;
  }
  const bool takes_gzip = request.header("accept-encoding").contains("gzip") && !file->gzipped.empty();
  if (takes_gzip) reply.headers.emplace_back("Content-Encoding", "gzip");
  reply.body = takes_gzip ? file->gzipped : file->bytes;
  return reply;
}

}  // namespace kerf::daemon
