#pragma once
// A request and its reply, without the library that carries them.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace kerf::io::web {

/// What a client asks. Paths are decoded and begin with `/`; one that leaves the root (`..`), or holds a NUL, does not
/// get this far.
struct HttpRequest {
  std::string method;
  std::string path;
  std::map<std::string, std::string> query;
  /// Names in lower case.
  std::map<std::string, std::string> headers;
  std::string body;
  /// "127.0.0.1:51234"
  std::string peer;

  /// Empty where there is none.
  [[nodiscard]] std::string_view header(const std::string& lower_case_name) const;
  [[nodiscard]] std::optional<std::string> parameter(const std::string& name) const;
};

/// A body that is made piece by piece, on a thread of the pool, as fast as the client takes it.
class BodySource {
 public:
  BodySource() = default;
  BodySource(const BodySource&) = delete;
  BodySource& operator=(const BodySource&) = delete;
  virtual ~BodySource() = default;
  /// Never empty; nothing at the end.
  [[nodiscard]] virtual std::optional<std::string> next() = 0;
};

struct HttpReply {
  using Body = std::variant<std::string, std::string_view, std::shared_ptr<BodySource>>;
  int status = 200;
  std::string content_type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers{};
  /// A view is of what lives as long as the program.
  Body body{};
};

/// Answers a request, at once or later; loop's thread.
using Answer = std::function<void(HttpReply)>;

/// Takes a body that is too long to be held, piece by piece. Destroyed before finish(): the client has gone.
class BodySink {
 public:
  BodySink() = default;
  BodySink(const BodySink&) = delete;
  BodySink& operator=(const BodySink&) = delete;
  virtual ~BodySink() = default;
  /// A reply ends the upload.
  [[nodiscard]] virtual std::optional<HttpReply> append(std::string_view bytes) = 0;
  virtual void finish(Answer answer) = 0;
};

/// "%41+" decoded; nothing where an escape is broken or means NUL.
[[nodiscard]] std::optional<std::string> decode_percent(std::string_view text, bool plus_is_blank = false);

/// Splits "/a/b?x=1&y=2" into path and parameters; nothing where it is not an absolute path within the root.
struct RequestTarget {
  std::string path;
  std::map<std::string, std::string> query;
};
[[nodiscard]] std::optional<RequestTarget> parse_target(std::string_view target);

}  // namespace kerf::io::web
