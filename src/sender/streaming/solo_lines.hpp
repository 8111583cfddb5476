#pragma once
// Lines that must travel alone.

#include <string_view>

namespace kerf::streaming {

/// Which lines a controller takes only when nothing else is on its way (protocol.md 6.5).
enum class SoloPolicy {
  DollarLines,      ///< `$` lines
  StoredWritesToo,  ///< also G10, G28.1 and G30.1: an AVR loses received bytes while it writes its EEPROM
  EveryLine,        ///< one line at a time
};

/// True when `text` must be sent alone: nothing before it unanswered, nothing after it until it is answered.
[[nodiscard]] bool must_travel_alone(std::string_view text, SoloPolicy policy);

/// `$J=…`, however it is written.
[[nodiscard]] bool is_jog(std::string_view text);

}  // namespace kerf::streaming
