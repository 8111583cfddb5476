#pragma once
// Takes passwords out of what a log holds, in such a way that a replay decides the same.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/protocol/secrets.hpp"

namespace kerf::session {

/// Replaces each password by a token of the same length: stars with a number at the end. The same password always has
/// the same token, a token stands for itself, and the stars that a controller prints instead of a password stay what
/// they are. So masked bytes compare as the original ones did: a value that was read back still equals the one written,
/// and masking a masked log changes nothing.
class PasswordMask {
 public:
  /// A line of the controller may say which settings hold passwords.
  void learn_from(std::string_view line) { secrets_.learn_from(line); }
  /// The same for a line that it said at another time.
  void recall_from(std::string_view line) { secrets_.recall_from(line); }
  [[nodiscard]] const protocol::Secrets& secrets() const { return secrets_; }

  /// A line without its end.
  [[nodiscard]] std::string masked_line(std::string_view line);
  /// Any number of whole lines.
  [[nodiscard]] std::string masked_text(std::string_view text);
  /// The token of `password`.
  [[nodiscard]] std::string token_of(std::string_view password);

 private:
  protocol::Secrets secrets_;
  /// In the order of their first appearance.
  std::vector<std::string> passwords_;
};

/// Masks a stream of bytes as it comes, however it is cut. From a possible password on, bytes are held back until the
/// line is complete; a line matters to nobody before.
class StreamMask {
 public:
  /// What can be said after `bytes` have come.
  [[nodiscard]] std::string push(std::string_view bytes, PasswordMask& mask);
  /// What was held back, when nothing more will come: nothing but stars.
  [[nodiscard]] std::string finish();

 private:
  void end_line(std::string& out, PasswordMask& mask);

  std::string line_;
  /// So much of `line_` has been given out.
  std::size_t given_ = 0;
};

}  // namespace kerf::session
