#pragma once
// What the controller sends, in order, as bytes.

#include <string>
#include <string_view>
#include <utility>

#include "common/protocol/encode.hpp"
#include "common/protocol/message.hpp"

namespace kerf::firmware {

/// Collects encoded messages until somebody takes them away. Every line ends in CR LF, on all firmwares.
class Outbox {
 public:
  explicit Outbox(protocol::PrintStyle style) : style_(style) {}

  void say(const protocol::Message& message) {
    // The welcome has an empty line before it (protocol.md 1.1).
    if (std::holds_alternative<protocol::Welcome>(message)) bytes_ += "\r\n";
    bytes_ += protocol::encode(message, style_);
    bytes_ += "\r\n";
  }
  /// As they are, without a line end.
  void say_bytes(std::string_view bytes) { bytes_ += bytes; }
  /// Follows `$13`.
  void set_style(const protocol::PrintStyle& style) { style_ = style; }
  [[nodiscard]] std::string take() { return std::exchange(bytes_, {}); }

 private:
  protocol::PrintStyle style_;
  std::string bytes_;
};

}  // namespace kerf::firmware
