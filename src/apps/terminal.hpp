#pragma once
// What the programs need to know about the terminal in front of the operator. Loop's thread only.

#include <functional>
#include <memory>
#include <string>

#include <termios.h>

#include "io/event_loop.hpp"

namespace kerf::apps {

[[nodiscard]] bool is_terminal(int descriptor);

/// Columns of the terminal on standard output; 80 when it does not say.
[[nodiscard]] int terminal_columns();

/// Whether the terminal shows UTF-8, as its locale says.
[[nodiscard]] bool shows_utf8();

/// Gives single keys without waiting for Enter, and puts the terminal back as it was. Ctrl-C stays a signal.
class KeyReader {
 public:
  KeyReader(io::EventLoop& loop, std::function<void(char)> key);
  ~KeyReader();
  KeyReader(const KeyReader&) = delete;
  KeyReader& operator=(const KeyReader&) = delete;

 private:
  void read();

  std::function<void(char)> key_;
  termios before_{};
  std::unique_ptr<io::ReadableWatch> watch_;
};

}  // namespace kerf::apps
