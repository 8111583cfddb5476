#include "sender/session/password_mask.hpp"

#include <algorithm>

#include "common/protocol/message_reader.hpp"

namespace kerf::session {
namespace {

constexpr std::string_view kLineEnds = "\r\n";
/// A setting begins with a dollar, a command of ESP3D with a bracket.
bool may_hold_secret(std::string_view text) {
  return text.contains('$') || text.contains('[');
}

constexpr std::string_view kDigits = "0123456789abcdefghijklmnopqrstuvwxyz";

}  // namespace

std::string PasswordMask::token_of(std::string_view password) {
  if (password.find_first_not_of('*') == std::string_view::npos) return std::string(password);
  std::size_t number = 1;  // among the passwords of this length
  bool is_known = false;
  for (const std::string& known : passwords_) {
    if (known.size() != password.size()) continue;
    is_known = known == password;
    if (is_known) break;
    ++number;
  }
  if (!is_known) passwords_.emplace_back(password);
  std::string token(password.size(), '*');
  for (std::size_t at = token.size(); number > 0 && at > 0; number /= kDigits.size()) {
    token[--at] = kDigits[number % kDigits.size()];
  }
  return token;
}

std::string PasswordMask::masked_line(std::string_view line) {
  std::string shown(line);
  if (const auto secret = secrets_.secret_in(line); !secret.empty()) {
    shown.replace(static_cast<std::size_t>(secret.data() - line.data()), secret.size(), token_of(secret));
  }
  return shown;
}

std::string PasswordMask::masked_text(std::string_view text) {
  if (!may_hold_secret(text)) return std::string(text);
  std::string shown;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(kLineEnds), text.size());
    shown += masked_line(text.substr(0, end));
    shown.append(text, end, 1);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return shown;
}

std::string StreamMask::push(std::string_view bytes, PasswordMask& mask) {
  // Whole lines such as "ok", thousands a second.
  const bool are_whole =
      line_.empty() && bytes.ends_with('\n') && bytes.size() <= protocol::MessageReader::kLongestLine;
  if (are_whole && !may_hold_secret(bytes)) return std::string(bytes);
  std::string out;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find_first_of(kLineEnds);
    const std::string_view part = bytes.substr(0, end);
    const std::size_t taken = std::min(part.size(), protocol::MessageReader::kLongestLine - line_.size());
    line_.append(part, 0, taken);
    bytes.remove_prefix(taken);
    if (taken < part.size()) {
      end_line(out, mask);  // a full piece of a longer line, as the reader cuts it
    } else if (end != std::string_view::npos) {
      end_line(out, mask);
      out += bytes.front();
      bytes.remove_prefix(1);
    }
  }
  const std::size_t open_until = mask.secrets().doubtful_from(line_);
  if (open_until > given_) {
    out.append(line_, given_, open_until - given_);
    given_ = open_until;
  }
  return out;
}

void StreamMask::end_line(std::string& out, PasswordMask& mask) {
  mask.learn_from(line_);
  if (line_.size() > given_) out.append(mask.masked_line(line_), given_);
  line_.clear();
  given_ = 0;
}

std::string StreamMask::finish() {
  std::string held(line_.size() - given_, '*');
  line_.clear();
  given_ = 0;
  return held;
}

}  // namespace kerf::session
