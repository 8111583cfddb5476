#pragma once
// Where Kerf keeps what it has to remember: $XDG_STATE_HOME/kerf, or ~/.local/state/kerf. Any thread.

#include <string>

namespace kerf::io {

/// The folder, made if it was not there; empty without a home, or where it cannot be made.
[[nodiscard]] std::string state_folder();

}  // namespace kerf::io
