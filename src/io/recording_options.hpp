#pragma once
// Whether and where connections are written down.

#include <string>

namespace kerf::io {

/// For one connection; docs/wire_log.md says what is in a log.
struct RecordingOptions {
  bool records = true;
  std::string folder{};  ///< empty: the user's own, $XDG_STATE_HOME/kerf/logs
};

}  // namespace kerf::io
