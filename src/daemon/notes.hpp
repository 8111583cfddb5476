#pragma once
// What the operator should know, the last of it.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "daemon/machine_view.hpp"
#include "io/wall_clock.hpp"

namespace kerf::daemon {

class Notes {
 public:
  /// The same sentence again only gets a new time.
  void add(NoteLevel level, std::string sentence) {
    if (sentence.empty()) return;
    if (!notes_.empty() && notes_.back().sentence == sentence) notes_.pop_back();
    notes_.push_back({.number = ++number_,
                      .at = io::to_string(io::wall_clock_now()),
                      .level = level,
                      .sentence = std::move(sentence)});
    if (notes_.size() > kKept) notes_.erase(notes_.begin());
  }
  [[nodiscard]] const std::vector<NoteView>& all() const { return notes_; }

 private:
  static constexpr std::size_t kKept = 50;
  std::uint64_t number_ = 0;
  std::vector<NoteView> notes_;
};

}  // namespace kerf::daemon
