#pragma once
// What a virtual machine has beyond its firmware's reference build.

#include <memory>

#include "firmware/card.hpp"

namespace kerf::firmware {

/// Only grblHAL has any of it. What is fitted is told by `$I`; what is not, does not exist.
struct Equipment {
  /// A slot with this card in it; null: no file system.
  std::shared_ptr<Card> card{};
  /// A second stream that a pendant may take over.
  bool pendant = false;
};

}  // namespace kerf::firmware
