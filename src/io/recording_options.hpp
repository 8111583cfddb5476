#pragma once
// Whether and where connections and jobs are written down.

#include <string>

#include "io/journal_options.hpp"

namespace kerf::io {

/// For one connection; docs/wire_log.md says what is in a log.
struct RecordingOptions {
  bool records = true;
  std::string folder{};  ///< empty: the user's own, $XDG_STATE_HOME/kerf/logs
  JournalOptions journal{};
};

}  // namespace kerf::io
