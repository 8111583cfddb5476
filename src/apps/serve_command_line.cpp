// The command line of `kerf serve`.

#include <memory>

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"
#include "apps/commands.hpp"

namespace kerf::apps {

void add_serve(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* command = kerf.add_subcommand("serve", "Own machines, and serve a web page and an API to work them");
  command
      ->add_option("-l,--listen", options->listen, "Listen at this address of this computer; port 0 takes a free one")
      ->type_name("ADDRESS:PORT")
      ->capture_default_str();
  command
      ->add_option("-m,--machine", options->machines,
                   std::string(kMachineHelp) +
                       "\nMore than one may be named. Without any: one virtual machine of each "
                       "firmware; others are added on the page.")
      ->allow_extra_args(false)
      ->type_name("URL");
  command->add_option("--program", options->program, "Put this file into the library and on every machine")
      ->type_name("FILE");
  command->add_option("--state", options->state_folder, "Keep programs, jobs and added machines in this folder")
      ->type_name("FOLDER");
  add_recording(*command, options->recording);
  command->footer(
      "\nExamples:\n"
      "  kerf serve                                  virtual machines to try, at http://127.0.0.1:8080\n"
      "  kerf serve -m /dev/ttyUSB0                  the machine on that port\n"
      "  ssh -L 8080:127.0.0.1:8080 workshop         its page, on another computer\n");
  command->callback([&chosen, options] { chosen = [options] { return serve(*options); }; });
}

}  // namespace kerf::apps
