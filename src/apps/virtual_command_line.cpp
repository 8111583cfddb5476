// The command line of `kerf virtual`.

#include <memory>

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "firmware/personality.hpp"

namespace kerf::apps {
namespace {

void add_virtual_places(CLI::App& command, VirtualOptions& options) {
  command
      .add_option("-l,--listen", options.listen,
                  "Serve at this address, such as tcp://127.0.0.1:5001 or ws://127.0.0.1:81; port 0 takes a free one")
      ->allow_extra_args(false)
      ->type_name("URL");
  command
      .add_option("--pty", options.ptys,
                  "Serve at a pseudo-terminal with this name, for senders that only know serial ports")
      ->allow_extra_args(false)
      ->type_name("PATH");
  command.add_flag("--welcome-on-connect", options.welcome_on_connect,
                   "Greet a TCP client as a network board does (grblhal)");
  command
      .add_option("--count", options.count,
                  "Be so many controllers, at ports one after the other and at PATH-1, PATH-2 …")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}

void add_virtual_play(CLI::App& command, VirtualOptions& options) {
  command
      .add_option("--script", options.scripts,
                  "Play this file: doors, switches, probe, power, cable and bytes that go wrong, each at its moment")
      ->allow_extra_args(false)
      ->type_name("FILE");
  command
      .add_option("--control", options.control,
                  "Take the same commands while it runs, at unix:PATH or tcp://127.0.0.1:PORT")
      ->type_name("URL");
  command.add_option("--log", options.log_file, "Write down everything that happens, as JSON lines; - is stderr")
      ->type_name("FILE");
}

void add_virtual_hardware(CLI::App& command, VirtualOptions& options) {
  constexpr const char* kHardware = "What the machine has";
  command.add_option("--axes", options.axes, "So many axes: X Y Z A B C U V (rabbit to 6, grblhal to 8)")
      ->type_name("N")
      ->group(kHardware);
  command.add_option("--tools", options.tools, "A tool table with so many entries, for G43 H and G10 L1 (grblhal)")
      ->type_name("N")
      ->group(kHardware);
  command
      .add_option("--ports", options.ports,
                  "User inputs and outputs for M62 to M68: digital inputs, digital outputs, analog inputs, analog "
                  "outputs (grblhal)")
      ->type_name("N,N,N,N")
      ->group(kHardware);
  command
      .add_flag("--spindle-encoder", options.spindle_encoder,
                "A spindle that tells its speed: G33, G76, G95 and ALARM:14 (grblhal)")
      ->group(kHardware);
  command
      .add_flag("--slow-memory", options.slow_memory,
                "Memory that takes milliseconds a byte, in which bytes on the wire are lost (grbl)")
      ->group(kHardware);
  command
      .add_option("--card", options.card_folder,
                  "An SD card: this folder; the machine takes $FM, $F and runs files (grblhal)")
      ->type_name("FOLDER")
      ->group(kHardware);
  command
      .add_option("--pendant", options.pendant,
                  "A pendant (MPG) beside the sender, served at tcp://127.0.0.1:5002 or pty:///tmp/pendant; or "
                  "'script': only scripts play it (grblhal)")
      ->type_name("URL")
      ->group(kHardware);
}

}  // namespace

void add_virtual(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<VirtualOptions>();
  CLI::App* command = kerf.add_subcommand("virtual", "Be a controller: serve a virtual machine to any sender");
  command
      ->add_option("-p,--personality", options->personality, "Which firmware to be: " + firmware::personality_names())
      ->type_name("NAME")
      ->capture_default_str();
  add_virtual_places(*command, *options);
  command->add_option("--speed", options->speed, "Pace: 1 is real time, 10 ten times as fast, max as fast as it can")
      ->type_name("N|max")
      ->capture_default_str();
  command->add_option("--settings", options->settings_file, "Start with the $n=value lines of this file")
      ->type_name("FILE");
  command
      ->add_option("--state", options->state_file,
                   "Keep settings and offsets in this file, as a real controller does in its memory")
      ->type_name("FILE");
  add_virtual_hardware(*command, *options);
  add_virtual_play(*command, *options);
  command->footer(
      "\nExamples:\n"
      "  kerf virtual --listen 127.0.0.1:5001                        a grblHAL for senders that know the network\n"
      "  kerf virtual -p grbl --pty /tmp/kerf-grbl                   a Grbl for senders that know serial ports\n"
      "  kerf virtual -l 127.0.0.1:5001 --control unix:/tmp/kerf-control\n"
      "  echo 'door open' | nc -NU /tmp/kerf-control                    somebody opens its door\n"
      "\nOne TCP client at a time; a second one is turned away while the first is connected.\n"
      "All commands of scripts and of the control socket: docs/virtual_controller.md, or say 'help' there.\n");
  command->callback([&chosen, options] { chosen = [options] { return serve_virtual(*options); }; });
}

}  // namespace kerf::apps
