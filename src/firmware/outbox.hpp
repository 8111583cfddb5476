#pragma once
// What the controller sends, in order, as bytes, on each of its wires.

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "common/protocol/encode.hpp"
#include "common/protocol/message.hpp"
#include "firmware/port.hpp"

namespace kerf::firmware {

/// Collects encoded messages until somebody takes them away. Every line ends in CR LF, on all firmwares. Reports,
/// alarms and the welcome go to every wire, everything else to the one in command (protocol.md 1, fact 3).
class Outbox {
 public:
  explicit Outbox(protocol::PrintStyle style) : style_(style) {}

  void say(const protocol::Message& message) {
    const bool is_for_all = std::holds_alternative<protocol::StatusReport>(message) ||
                            std::holds_alternative<protocol::AlarmRaised>(message) ||
                            std::holds_alternative<protocol::Welcome>(message);
    if (!is_for_all) return say_to(in_command_, message);
    say_to(Port::Main, message);
    if (has_pendant_) say_to(Port::Pendant, message);
  }
  void say_to(Port port, const protocol::Message& message) {
    std::string& bytes = bytes_of(port);
    // The welcome has an empty line before it (protocol.md 1.1).
    if (std::holds_alternative<protocol::Welcome>(message)) bytes += "\r\n";
    bytes += protocol::encode(message, style_);
    bytes += "\r\n";
  }
  /// As they are, without a line end.
  void say_bytes(std::string_view bytes) { bytes_of(in_command_) += bytes; }

  /// Follows `$13`.
  void set_style(const protocol::PrintStyle& style) { style_ = style; }
  void fit_pendant() { has_pendant_ = true; }
  void put_in_command(Port port) { in_command_ = port; }
  [[nodiscard]] std::string take(Port port) { return std::exchange(bytes_of(port), {}); }

 private:
  [[nodiscard]] std::string& bytes_of(Port port) { return bytes_.at(static_cast<std::size_t>(port)); }

  protocol::PrintStyle style_;
  std::array<std::string, kPorts> bytes_;
  Port in_command_ = Port::Main;
  bool has_pendant_ = false;
};

}  // namespace kerf::firmware
