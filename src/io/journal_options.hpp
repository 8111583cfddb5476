#pragma once
// Whether and where jobs are written down.

#include <string>

namespace kerf::io {

struct JournalOptions {
  bool keeps = false;
  std::string folder{};  ///< empty: the user's own, $XDG_STATE_HOME/kerf
};

}  // namespace kerf::io
