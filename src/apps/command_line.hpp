#pragma once
// Parts of the command line that have a file of their own.

#include <functional>
#include <string>

#include "apps/exit_status.hpp"
#include "io/recording_options.hpp"

namespace CLI {
class App;
}

namespace kerf::apps {

/// The sub-command that was chosen, ready to run.
using Chosen = std::function<ExitStatus()>;

/// Whether and where a connection is written down.
void add_recording(CLI::App& command, io::RecordingOptions& recording);
/// The options of every command that connects to a machine.
void add_machine(CLI::App& command, std::string& machine, io::RecordingOptions& recording);

/// `kerf run`.
void add_run(CLI::App& kerf, Chosen& chosen);
/// `kerf resume`.
void add_resume(CLI::App& kerf, Chosen& chosen);
/// `kerf virtual`.
void add_virtual(CLI::App& kerf, Chosen& chosen);

}  // namespace kerf::apps
