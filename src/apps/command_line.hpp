#pragma once
// Parts of the command line that have a file of their own.

#include <functional>

#include "apps/exit_status.hpp"

namespace CLI {
class App;
}

namespace kerf::apps {

/// The sub-command that was chosen, ready to run.
using Chosen = std::function<ExitStatus()>;

/// `kerf virtual`.
void add_virtual(CLI::App& kerf, Chosen& chosen);

}  // namespace kerf::apps
