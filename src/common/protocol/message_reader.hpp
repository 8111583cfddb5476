#pragma once
// Bytes from a controller to messages. However the bytes are split, the same messages come out.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/protocol/message.hpp"

namespace kerf::protocol {

/// A message and the bytes that it was read from, without line ends.
struct ReceivedMessage {
  Message message;
  std::string raw;
  friend bool operator==(const ReceivedMessage&, const ReceivedMessage&) = default;
};

BOOST_DESCRIBE_STRUCT(ReceivedMessage, (), (message, raw))

/// Cuts a byte stream at CR and LF, leaves out empty lines and decodes the rest. Keeps at most one piece of
/// `kLongestLine` bytes: a longer line comes out as `Unrecognized` pieces, never decoded.
class MessageReader {
 public:
  static constexpr std::size_t kLongestLine = 4096;

  /// The messages that `bytes` complete, in order.
  [[nodiscard]] std::vector<ReceivedMessage> read(std::string_view bytes);

  /// The unfinished line.
  [[nodiscard]] std::string_view pending() const { return pending_; }

  /// Forgets the unfinished line: after a port was opened or lost.
  void reset();

 private:
  void finish_line(std::vector<ReceivedMessage>& out);

  std::string pending_;
  bool inside_long_line_ = false;
};

}  // namespace kerf::protocol
