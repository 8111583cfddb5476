// `kerf`: reads the command line and calls one of the sub-commands. It and the *_command_line.cpp beside it are the
// only files that know CLI11.

#include <algorithm>
#include <csignal>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/command_line.hpp"
#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "firmware/personality.hpp"

namespace {

using kerf::apps::ExitStatus;

constexpr const char* kVersion = KERF_VERSION;

constexpr const char* kFooter =
    "\nFirst steps, without a machine:\n"
    "  kerf run examples/coaster.nc --machine \"virtual:grblhal?speed=20\"\n"
    "With one:\n"
    "  kerf ports                                which ports are there?\n"
    "  kerf info --machine /dev/ttyUSB0          what is on that port?\n"
    "  kerf run part.nc --machine /dev/ttyUSB0   cut a file; Ctrl-C holds\n"
    "\n'kerf COMMAND --help' says more about a command.\n"
    "Exit status: 0 done, 1 wrong option or file, 2 no connection, 3 a line was refused, 4 alarm, 5 interrupted.\n";

using kerf::apps::add_machine;
using kerf::apps::add_recording;
using kerf::apps::Chosen;
using kerf::apps::kMachineHelp;

void add_describe(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::DescribeOptions>();
  CLI::App* command = kerf.add_subcommand("info", "Say what a controller is and can do, as it tells itself");
  add_machine(*command, options->machine, options->recording);
  command->add_flag("--json", options->json, "Print everything as one JSON object");
  command->footer("");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::describe_machine(*options); }; });
}

void add_status(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::StatusOptions>();
  CLI::App* command = kerf.add_subcommand("status", "Say what the machine is doing: state, position, inputs, alarms");
  add_machine(*command, options->machine, options->recording);
  command->add_flag("-w,--watch", options->watch,
                    "Go on until Ctrl-C: one line on a terminal, else one JSON object a line for each change");
  command->add_flag("--json", options->json, "Print everything that is known as JSON");
  command->footer("\nExit status 4: the machine is in alarm. 'kerf status' asks and changes nothing.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::show_status(*options); }; });
}

void add_codes(CLI::App& kerf, Chosen& chosen, bool errors) {
  auto options = std::make_shared<kerf::apps::CodesOptions>();
  options->errors = errors;
  CLI::App* command = errors ? kerf.add_subcommand("errors", "List what the numbers behind 'error:' mean")
                             : kerf.add_subcommand("alarms", "List what the numbers behind 'ALARM:' mean");
  command->add_option("CODE", options->code, "Explain this one, and say what to do")->type_name("");
  add_machine(*command, options->machine, options->recording);
  command
      ->add_option("-p,--personality", options->personality,
                   "Ask no machine, but Kerf's own tables: " + kerf::firmware::personality_names())
      ->type_name("NAME")
      ->excludes(command->get_option("--machine"));
  command->add_flag("--json", options->json, "Print JSON");
  command->footer(errors ? "\nExample: kerf errors 20 --personality grbl\n"
                         : "\nExample: kerf alarms 2 --personality grbl\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::list_codes(*options); }; });
}

void add_console(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::ConsoleOptions>();
  CLI::App* command = kerf.add_subcommand("console", "Type to a controller; answers come with their meaning");
  add_machine(*command, options->machine, options->recording);
  command->add_flag(
      "--reset", options->may_reset,
      "Reset a controller that answers nothing, as one in a hard-limit alarm; whatever it does, it stops");
  command->add_flag("-v,--verbose", options->verbose, "Also show each step of getting to know the controller");
  command->footer(
      "\nAt the start of a line these keys act at once: ? status, ! feed hold, ~ cycle start, Ctrl-X reset.\n"
      "Arrow up brings back earlier lines; Ctrl-D leaves.\n"
      "For Kerf itself: :status says everything that is known, :why explains the alarm, :take takes the machine back\n"
      "from a pendant.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::console(*options); }; });
}

void add_ports(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::PortsOptions>();
  CLI::App* command = kerf.add_subcommand("ports", "List what --machine could name: serial ports, network, virtual");
  command->add_flag("--network", options->network, "Also look for machines that announce themselves (mDNS)");
  command->add_flag("--watch", options->watch, "Print the list again whenever it changes, until Ctrl-C");
  command->add_flag("--json", options->json, "Print the list as one JSON object (with --watch, one a line)");
  command->footer("");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::list_ports(*options); }; });
}

using SettingsCommand = ExitStatus (*)(const kerf::apps::SettingsOptions&);

/// One of the sub-commands of `kerf settings`.
CLI::App& add_settings_command(CLI::App& settings, Chosen& chosen, std::shared_ptr<kerf::apps::SettingsOptions> options,
                               const char* name, const char* help, SettingsCommand run) {
  CLI::App* command = settings.add_subcommand(name, help);
  add_machine(*command, options->machine, options->recording);
  command->add_flag("--json", options->json, "Print JSON");
  command->footer("");
  command->callback([&chosen, options, run] { chosen = [options, run] { return run(*options); }; });
  return *command;
}

constexpr const char* kSetHelp = "A file, @NUMBER of the history, or now: what the machine has";

void add_settings_changes(CLI::App& settings, Chosen& chosen,
                          const std::shared_ptr<kerf::apps::SettingsOptions>& options) {
  CLI::App& set = add_settings_command(settings, chosen, options, "set", "Change settings: checked, written, read back",
                                       kerf::apps::set_settings);
  set.add_option("ID=VALUE", options->items, "Such as 110=600, 22=+Allow manual, 23=XZ, 13=off")
      ->required()
      ->type_name("");
  CLI::App& restore = add_settings_command(settings, chosen, options, "restore", "Put a set back: all of it or nothing",
                                           kerf::apps::restore_settings);
  restore.add_option("SET", options->sets, kSetHelp)->required()->expected(1)->type_name("");
  restore.add_flag("--force", options->force, "Even if the set is of another firmware");
  for (CLI::App* command : {&set, &restore}) {
    command->add_option("--reason", options->reason, "Why, for the history")->type_name("TEXT");
    command->add_flag("-n,--dry-run", options->dry_run, "Only say what would change");
    command->add_flag("--allow-motion", options->allows_motion, "Even if a startup line moves the machine");
  }
}

void add_settings(CLI::App& kerf, Chosen& chosen) {
  using namespace kerf::apps;
  auto options = std::make_shared<SettingsOptions>();
  CLI::App* settings = kerf.add_subcommand("settings", "Show, change, save and restore a machine's settings");
  settings->require_subcommand(1);
  settings->footer("\nEvery set that a machine was seen with is kept: 'kerf settings history' lists them.\n");
  CLI::App& list = add_settings_command(*settings, chosen, options, "list", "All settings, by group", list_settings);
  list.add_option("-g,--group", options->group, "Only this group, by name or number")->type_name("NAME");
  list.add_flag("-v,--verbose", options->verbose, "Also what each takes and does");
  CLI::App& get =
      add_settings_command(*settings, chosen, options, "get", "Everything about some settings", get_settings);
  get.add_option("ID", options->items, "Such as 110 or Homing/Enable")->required()->type_name("");
  add_settings_changes(*settings, chosen, options);
  CLI::App& diff =
      add_settings_command(*settings, chosen, options, "diff", "What differs between two sets", diff_settings);
  diff.add_option("SET", options->sets, kSetHelp)->required()->expected(1, 2)->type_name("");
  CLI::App& save =
      add_settings_command(*settings, chosen, options, "save", "Write the settings into a file", save_settings);
  save.add_option("FILE", options->sets, "The file; - is standard output")->required()->expected(1)->type_name("");
  add_settings_command(*settings, chosen, options, "history", "What the machine was seen with, and when",
                       list_settings_history);
}

void add_verify(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::VerifyOptions>();
  CLI::App* command = kerf.add_subcommand("verify", "Hold recorded conversations (.talk files) with a controller");
  command->add_option("FILE", options->files, ".talk files, or folders of them")->required()->type_name("");
  CLI::Option* machine =
      command
          ->add_option(
              "-m,--machine", options->machine,
              "The controller to talk to, in real time;\nwithout it, the virtual one of each talk's personality")
          ->type_name("URL");
  command
      ->add_option("-p,--personality", options->personality, "Only the talks of " + kerf::firmware::personality_names())
      ->type_name("NAME")
      ->excludes(machine);
  command->add_flag("-v,--verbose", options->verbose, "Show every line said and heard");
  add_recording(*command, options->recording);
  command->footer("\nOn a real machine a talk moves axes and may change settings: take the tool out first.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::verify(*options); }; });
}

void add_case_machine(CLI::App& command, kerf::apps::CaseMachineOptions& machine) {
  kerf::apps::add_virtual_machine(command, machine);
  command
      .add_option("--limit-switch-at", machine.limit_switches,
                  "Where the limit switches close, in mm from where the machine was switched on")
      ->type_name("X,Y,Z");
  command.add_option("--probe-contact-at", machine.probe_contact_mm, "The machine Z in mm at which the probe closes")
      ->type_name("Z");
}

void add_conform(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::ConformOptions>();
  CLI::App* command = kerf.add_subcommand("conform", "Ask a virtual machine the questions of a .jsonl file");
  command->add_option("FILE", options->file, "One case a line, as a JSON object")->required()->type_name("");
  add_case_machine(*command, options->machine);
  command->footer("\nPrints one record of answers a case, to compare with those of real firmware.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::conform(*options); }; });
}

void add_simulate(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::SimulateOptions>();
  CLI::App* command =
      kerf.add_subcommand("simulate", "Run a file on a virtual machine at once, and say how long it takes");
  command->add_option("FILE", options->file, "The G-code file")->required()->type_name("");
  add_case_machine(*command, options->machine);
  command->add_flag("--json", options->json, "Print the result as one JSON object");
  command->add_option("--trace", options->trace_file, "Write a table of all blocks and their times")->type_name("CSV");
  CLI::Option* positions =
      command->add_option("--positions", options->positions_file, "Write a table of positions over time")
          ->type_name("CSV");
  command->add_option("--every", options->every_s, "Seconds between two positions")
      ->type_name("S")
      ->needs(positions)
      ->capture_default_str();
  command->add_option("--inject", options->inject, "A realtime byte and its second, such as 1.5:0x21 for a feed hold")
      ->type_name("T:0xBB");
  command
      ->add_option("--link", options->link,
                   "How lines arrive: as fast as they are read, or over a serial port of this baud rate")
      ->type_name("saturated|BAUD")
      ->capture_default_str();
  command->footer("");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::simulate(*options); }; });
}

void add_estimate(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::EstimateOptions>();
  CLI::App* command = kerf.add_subcommand("estimate", "Say how long a job takes, and what the time is spent on");
  command->add_option("FILE", options->file, "The G-code file")->required()->type_name("");
  add_case_machine(*command, options->virtual_machine);
  command->add_option("-m,--machine", options->machine, "Ask this machine for its firmware and settings; nothing moves")
      ->type_name("URL")
      ->excludes("--personality")
      ->excludes("--settings");
  add_recording(*command, options->recording);
  command
      ->add_option("--link", options->link,
                   "Also say what becomes of it over a serial port of this baud rate, and where the machine waits for "
                   "lines")
      ->type_name("saturated|BAUD")
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print the result as one JSON object");
  command->footer("\nExit status 3: lines would be refused, or the job would not reach its end.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::estimate(*options); }; });
}

void add_check(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::CheckOptions>();
  CLI::App* command = kerf.add_subcommand("check", "Find what would go wrong, before anything moves");
  command->add_option("FILE", options->file, "The G-code file")->required()->type_name("");
  add_case_machine(*command, options->virtual_machine);
  command
      ->add_option("-m,--machine", options->machine,
                   "Ask this machine for its firmware, settings, offsets and position; nothing moves")
      ->type_name("URL")
      ->excludes("--personality")
      ->excludes("--settings");
  add_recording(*command, options->recording);
  command->add_option("--zero", options->zero, "Machine position of the work zero, for a machine that is not asked")
      ->type_name("X,Y,Z")
      ->excludes("--machine");
  command->add_option("--position", options->position, "Machine position of the tool when the program starts")
      ->type_name("X,Y,Z")
      ->excludes("--machine");
  command->add_flag("--json", options->json, "Print the result as one JSON object");
  command->footer(
      "\nExit status: 0 nothing to worry about, 6 warnings, 3 errors (lines that this controller would refuse, or stop "
      "at with an alarm): docs/check.md.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::check(*options); }; });
}

void add_record(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::RecordOptions>();
  CLI::App* command = kerf.add_subcommand("record", "Watch a machine and write down what is said, until Ctrl-C");
  command->add_option("-m,--machine", options->machine, kMachineHelp)->type_name("URL")->capture_default_str();
  command->add_option("--record", options->recording.folder, "Keep the log in this folder")->type_name("FOLDER");
  command->add_flag("--listen", options->listens, "Only listen: send not a byte, and ask nothing");
  command->add_flag("--reports", options->shows_reports, "Show status reports and the questions for them too");
  command->add_flag("-q,--quiet", options->quiet, "Show nothing of it");
  command->footer("\nEvery other command that connects writes its log too, unless told --no-record.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::record(*options); }; });
}

void add_log_show(CLI::App& log, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::LogShowOptions>();
  CLI::App* command = log.add_subcommand("show", "Print a log, one line for each line that was said");
  command->add_option("LOG", options->log, "A log: its path, its name in the folder of logs, or latest")
      ->type_name("")
      ->capture_default_str();
  command->add_option("--direction", options->direction, "Only what was sent, or only what was received")
      ->check(CLI::IsMember({"sent", "received", "both"}))
      ->type_name("sent|received|both");
  command
      ->add_option(
          "--kind", options->kinds,
          "Only these kinds: ok, error, alarm, status, welcome, setting, feedback … of what was received; line, "
          "realtime; command, program, opened, closed, header, time")
      ->delimiter(',')
      ->type_name("KIND,…");
  command->add_option("--hide", options->hidden, "All but these kinds")->delimiter(',')->type_name("KIND,…");
  command
      ->add_option("--since", options->since, "From this moment on: 12.5 (seconds as shown), 13:05:01, or with a date")
      ->type_name("WHEN");
  command->add_option("--until", options->until, "Before this moment")->type_name("WHEN");
  command->add_option("--grep", options->pattern, "Only lines in which this regular expression is found")
      ->type_name("REGEX");
  command->add_flag("--clock", options->by_clock, "Show the time of day (UTC) instead of seconds");
  command->add_flag("--json", options->json, "Print one JSON object a line");
  command->footer("\nSigns: > a line sent, ! realtime bytes sent, < a line received.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::show_log(*options); }; });
}

void add_log(CLI::App& kerf, Chosen& chosen) {
  CLI::App* command = kerf.add_subcommand("log", "Look into the logs of connections");
  command->require_subcommand(1);
  add_log_show(*command, chosen);
  auto options = std::make_shared<kerf::apps::LogListOptions>();
  CLI::App* list = command->add_subcommand("list", "List the logs, the newest last");
  list->add_option("FOLDER", options->folder, "Where they are, if not in the usual place")->type_name("");
  list->add_flag("--json", options->json, "Print the list as JSON");
  list->footer("");
  list->callback([&chosen, options] { chosen = [options] { return kerf::apps::list_logs(*options); }; });
}

void add_replay(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<kerf::apps::ReplayOptions>();
  CLI::App* command =
      kerf.add_subcommand("replay", "Decide once more what Kerf decided in a log, and compare the bytes");
  command->add_option("LOG", options->log, "A log: its path, its name in the folder of logs, or latest")
      ->required()
      ->type_name("");
  command->add_option("--program", options->program, "The G-code file of the job, when it was too large for the log")
      ->type_name("FILE");
  command->add_flag("-v,--verbose", options->verbose, "Show what Kerf told meanwhile");
  command->add_flag("--json", options->json, "Print the result as one JSON object");
  command->footer("\nExit status: 0 the same bytes, 1 this log cannot be replayed, 3 other bytes.\n");
  command->callback([&chosen, options] { chosen = [options] { return kerf::apps::replay(*options); }; });
}

/// What is wrong with the command line, as one sentence that ends with what to do.
std::string sentence_of(const CLI::App& kerf, const CLI::ParseError& error, std::string_view first_word) {
  std::string help = "kerf --help";
  std::vector<std::string> unknown = kerf.remaining();
  for (const CLI::App* command : kerf.get_subcommands()) {
    help = "kerf " + command->get_name() + " --help";
    if (unknown.empty()) unknown = command->remaining();
  }
  if (kerf.get_subcommands().empty()) {
    const std::string_view kind = first_word.starts_with('-') ? "option" : "command";
    return fmt::format("There is no {} '{}': see '{}'.", kind, first_word, help);
  }
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !unknown.empty()) {
    return fmt::format("'{}' is not understood here: see '{}'.", unknown.front(), help);
  }
  std::string what = error.what();
  std::ranges::replace(what, '\n', ' ');
  while (what.ends_with('.') || what.ends_with(' ')) what.pop_back();
  return fmt::format("{}: see '{}'.", what, help);
}

int start(int argc, char** argv) {
  CLI::App kerf("Kerf sends G-code to Grbl, Rabbit GRBL and grblHAL machines, and can be one.", "kerf");
  kerf.set_version_flag("--version", fmt::format("kerf {}", kVersion));
  kerf.require_subcommand(1);
  kerf.footer(kFooter);
  Chosen chosen;
  kerf::apps::add_run(kerf, chosen);
  kerf::apps::add_resume(kerf, chosen);
  kerf::apps::add_audit(kerf, chosen);
  kerf::apps::add_serve(kerf, chosen);
  kerf::apps::add_virtual(kerf, chosen);
  add_describe(kerf, chosen);
  add_status(kerf, chosen);
  add_codes(kerf, chosen, false);
  add_codes(kerf, chosen, true);
  add_console(kerf, chosen);
  add_settings(kerf, chosen);
  add_ports(kerf, chosen);
  add_verify(kerf, chosen);
  add_conform(kerf, chosen);
  add_simulate(kerf, chosen);
  add_estimate(kerf, chosen);
  add_check(kerf, chosen);
  kerf::apps::add_plot(kerf, chosen);
  kerf::apps::add_transform(kerf, chosen);
  kerf::apps::add_report(kerf, chosen);
  add_record(kerf, chosen);
  add_log(kerf, chosen);
  add_replay(kerf, chosen);
  if (argc < 2) {
    kerf::apps::put("{}", kerf.help());
    return static_cast<int>(ExitStatus::Usage);
  }
  try {
    kerf.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return kerf.exit(error);
    kerf::apps::complain(sentence_of(kerf, error, argv[1]));
    return static_cast<int>(ExitStatus::Usage);
  }
  return static_cast<int>(chosen());
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a log or table that grows too large is an error of that write, too
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe or socket is an error of that write, not the end of the program
  try {
    return start(argc, argv);
  } catch (const std::exception& error) {
    kerf::apps::complain(fmt::format("Something unexpected happened ({}): please report it.", error.what()));
    return static_cast<int>(ExitStatus::Interrupted);
  }
}
