#include "common/protocol/message_reader.hpp"

#include <algorithm>
#include <utility>

#include "common/protocol/decode.hpp"

namespace kerf::protocol {

std::vector<ReceivedMessage> MessageReader::read(std::string_view bytes) {
  std::vector<ReceivedMessage> out;
  out.reserve(static_cast<std::size_t>(std::ranges::count(bytes, '\n')) + 1);
  while (!bytes.empty()) {
    const auto* const line_end = std::ranges::find_if(bytes, [](char byte) { return byte == '\r' || byte == '\n'; });
    const std::size_t end =
        line_end == bytes.end() ? std::string_view::npos : static_cast<std::size_t>(line_end - bytes.begin());
    const std::string_view part = bytes.substr(0, end);
    const std::size_t taken = std::min(part.size(), kLongestLine - pending_.size());
    pending_.append(part.substr(0, taken));
    bytes.remove_prefix(taken);
    if (taken < part.size()) {
      // A full piece, with more of the same line behind it.
      out.push_back({Unrecognized{pending_}, pending_});
      pending_.clear();
      inside_long_line_ = true;
    } else if (end != std::string_view::npos) {
      bytes.remove_prefix(1);
      finish_line(out);
    }
  }
  return out;
}

void MessageReader::finish_line(std::vector<ReceivedMessage>& out) {
  if (!pending_.empty()) {
    Message message = inside_long_line_ ? Message{Unrecognized{pending_}} : decode(pending_);
    out.push_back({std::move(message), std::exchange(pending_, {})});
  }
  inside_long_line_ = false;
}

void MessageReader::reset() {
  pending_.clear();
  inside_long_line_ = false;
}

}  // namespace kerf::protocol
