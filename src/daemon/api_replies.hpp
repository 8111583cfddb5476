#pragma once
// Replies as the API gives them.

#include <string>
#include <utility>

#include <boost/describe.hpp>

#include "io/json.hpp"
#include "io/web/http.hpp"

namespace kerf::daemon {

/// Why a request was not carried out: a word for programs, a sentence for people.
struct ApiError {
  std::string code;
  std::string sentence;
};
BOOST_DESCRIBE_STRUCT(ApiError, (), (code, sentence))
struct ApiErrorReply {
  ApiError error;
};
BOOST_DESCRIBE_STRUCT(ApiErrorReply, (), (error))

[[nodiscard]] inline io::web::HttpReply json_reply(const io::Json& json, int status = 200) {
  return {.status = status, .headers = {{"Cache-Control", "no-store"}}, .body = io::print(json)};
}

[[nodiscard]] inline io::web::HttpReply error_reply(int status, std::string code, std::string sentence) {
  return json_reply(io::to_json(ApiErrorReply{{.code = std::move(code), .sentence = std::move(sentence)}}), status);
}

}  // namespace kerf::daemon
