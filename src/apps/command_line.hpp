#pragma once
// Parts of the command line that have a file of their own.

#include <functional>
#include <string>

#include "apps/commands.hpp"
#include "apps/exit_status.hpp"
#include "io/recording_options.hpp"

namespace CLI {
class App;
}

namespace kerf::apps {

/// The sub-command that was chosen, ready to run.
using Chosen = std::function<ExitStatus()>;

/// Of the option --machine.
inline constexpr const char* kMachineHelp =
    "Where the machine is:\n"
    "  /dev/ttyUSB0       a serial port (in full: serial:///dev/ttyUSB0?baud=115200)\n"
    "  serial://usb/A906  the port with this USB serial number, wherever it is\n"
    "  HOST:PORT          a machine in the network (tcp://HOST:PORT)\n"
    "  ws://HOST:PORT     the same through a WebSocket\n"
    "  /tmp/kerf-grbl     a pseudo-terminal (pty:///tmp/kerf-grbl)\n"
    "  virtual:grblhal    a machine inside Kerf: grbl, rabbit, grblhal or\n                     grblhal-expr; add "
    "?speed=20 or ?speed=max";

/// Whether and where a connection is written down.
void add_recording(CLI::App& command, io::RecordingOptions& recording);
/// The options of every command that connects to a machine.
void add_machine(CLI::App& command, std::string& machine, io::RecordingOptions& recording);

/// The firmware and the settings of a machine that is only rehearsed on.
void add_virtual_machine(CLI::App& command, CaseMachineOptions& machine);

/// `kerf run`.
void add_run(CLI::App& kerf, Chosen& chosen);
/// `kerf resume`.
void add_resume(CLI::App& kerf, Chosen& chosen);
/// `kerf audit`.
void add_audit(CLI::App& kerf, Chosen& chosen);
/// `kerf transform`.
void add_transform(CLI::App& kerf, Chosen& chosen);
/// `kerf serve`.
void add_serve(CLI::App& kerf, Chosen& chosen);
/// `kerf virtual`.
void add_virtual(CLI::App& kerf, Chosen& chosen);

/// `kerf plot`.
void add_plot(CLI::App& kerf, Chosen& chosen);
/// `kerf report`.
void add_report(CLI::App& kerf, Chosen& chosen);

}  // namespace kerf::apps
