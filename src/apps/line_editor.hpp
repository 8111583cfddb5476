#pragma once
// Line editing with history on a terminal, or plain lines from a pipe, both fed by the event loop. Loop's thread only.

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "io/event_loop.hpp"

namespace kerf::apps {

/// What somebody types.
struct InputCallbacks {
  /// A line without its end.
  std::function<void(std::string_view)> line;
  /// A key that acts at once: it was typed at the start of a line.
  std::function<void(char)> realtime_key;
  std::function<void()> ended;
};

class InputReader {
 public:
  InputReader() = default;
  virtual ~InputReader() = default;
  InputReader(const InputReader&) = delete;
  InputReader& operator=(const InputReader&) = delete;

  /// Prints a line without disturbing what is being typed.
  virtual void print(std::string_view line) = 0;
  /// Forgets what is being typed. False if there was nothing.
  virtual bool clear_line() = 0;
};

/// Keys that a controller takes as commands wherever they stand: `?`, `!`, `~`, Ctrl-X.
[[nodiscard]] bool is_realtime_key(char key);

/// Emacs keys, history kept in `history_file` from one session to the next.
[[nodiscard]] std::unique_ptr<InputReader> make_line_editor(io::EventLoop& loop, std::string prompt,
                                                            std::string history_file, InputCallbacks callbacks);
/// A line that is nothing but one realtime key counts as that key.
[[nodiscard]] std::unique_ptr<InputReader> make_plain_reader(io::EventLoop& loop, InputCallbacks callbacks);

}  // namespace kerf::apps
