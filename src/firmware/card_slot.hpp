#pragma once
// The slot that a card sits in, and what the controller knows of it.

#include <memory>
#include <string>

#include "firmware/card.hpp"

namespace kerf::firmware {

/// Part of the board. Without a card the build has no file system at all: no commands, no fields.
struct CardSlot {
  std::shared_ptr<Card> card{};
  bool mounted = false;
  /// `SD:` is owed since the card was mounted or unmounted.
  bool mount_changed = false;
  /// Since the first mount full reports tell the state of the card (grblHAL sdcard.c).
  bool is_reported = false;
  /// The working directory.
  std::string folder = "/";

  [[nodiscard]] bool exists() const { return card != nullptr; }
};

}  // namespace kerf::firmware
