#pragma once
// Hears what a firmware says about itself during a handshake, so that it can be kept for the next one.

#include <optional>
#include <utility>

#include "sender/machine/words.hpp"
#include "sender/session/event.hpp"

namespace kerf::session {

/// Told of everything that a session tells.
class WordsListener {
 public:
  void on_event(const Event& event);
  /// What was kept is as good as heard.
  void start_from(machine::Words words) { words_ = std::move(words); }
  [[nodiscard]] const machine::Words& words() const { return words_; }
  /// Something came that was not known; once.
  [[nodiscard]] bool take_news() { return std::exchange(has_news_, false); }

 private:
  void on_line(const LineReceived& line);

  machine::Words words_;
  /// The answer under way.
  std::optional<machine::KeptAnswer> open_;
  bool has_news_ = false;
};

}  // namespace kerf::session
