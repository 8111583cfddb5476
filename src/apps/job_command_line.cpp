// The command lines of `kerf run` and `kerf resume`, and the options of all commands that connect to a machine.

#include <map>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/command_line.hpp"
#include "apps/commands.hpp"

namespace kerf::apps {
namespace {

/// The options of every command that runs a job.
void add_journal(CLI::App& command, io::JournalOptions& journal) {
  journal.keeps = true;
  CLI::Option* folder =
      command.add_option("--journal", journal.folder, "Keep the journal from which jobs are resumed in this folder")
          ->type_name("FOLDER");
  command.add_flag("!--no-journal", journal.keeps, "Keep no journal: the job cannot be resumed after a crash")
      ->excludes(folder);
}

/// How a job is run.
void add_job_options(CLI::App& command, JobChoices& choices) {
  using job::ErrorPolicy;
  using job::ProgramSwitch;
  using streaming::FlowPolicy;
  static const std::map<std::string, FlowPolicy> kFlows{{"counting", FlowPolicy::CharacterCounting},
                                                        {"one-at-a-time", FlowPolicy::OneAtATime}};
  static const std::map<std::string, ErrorPolicy> kPolicies{
      {"hold", ErrorPolicy::HoldAndAsk}, {"stop", ErrorPolicy::Stop}, {"continue", ErrorPolicy::Continue}};
  static const std::map<std::string, ProgramSwitch> kSwitches{
      {"machine", ProgramSwitch::AsMachine}, {"on", ProgramSwitch::On}, {"off", ProgramSwitch::Off}};
  auto& job = choices.options;
  command
      .add_option("--policy", job.flow,
                  "How lines are fed: as many as the controller has room for (default), or one at a time")
      ->transform(CLI::CheckedTransformer(kFlows).description(""))
      ->type_name("counting|one-at-a-time");
  command
      .add_option(
          "--on-error", choices.on_error,
          "A refused line: hold and ask (default on a terminal), stop (default elsewhere) or continue without it")
      ->transform(CLI::CheckedTransformer(kPolicies).description(""))
      ->type_name("hold|stop|continue");
  command.add_option("--optional-stop", job.optional_stop, "Stop at M1; by default as the machine does it")
      ->transform(CLI::CheckedTransformer(kSwitches).description(""))
      ->type_name("on|off|machine");
  command
      .add_option("--block-delete", job.block_delete,
                  "Leave out lines that begin with /; by default as the machine does it")
      ->transform(CLI::CheckedTransformer(kSwitches).description(""))
      ->type_name("on|off|machine");
}

constexpr const char* kWay = "The way to the line";

/// The way to the line from which a job goes on; `needs` is the option without which there is none, or null.
void add_choices(CLI::App& command, ResumeChoices& choices, CLI::Option* needs) {
  command.add_option("--safe-height", choices.safe_height_mm, "Go across at this Z, in machine coordinates")
      ->type_name("MM")
      ->group(kWay);
  command.add_option("--plunge-feed", choices.plunge_mm_per_min, "Go down at this feed")
      ->type_name("MM/MIN")
      ->check(CLI::PositiveNumber)
      ->group(kWay);
  command.add_option("--spin-up", choices.spin_up_s, "Give the spindle so long to come up to speed")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber)
      ->group(kWay);
  command
      .add_option("--offsets", choices.offsets,
                  "Where the machine has other offsets than the job left: refuse (agree), take the machine's (present) "
                  "or put back the job's (job)")
      ->check(CLI::IsMember({"agree", "present", "job"}))
      ->capture_default_str()
      ->group(kWay);
  command.add_flag("--position-is-right", choices.position_is_right, "The machine is where it says: do not home it")
      ->group(kWay);
  command.add_flag("-n,--dry-run", choices.dry_run, "Only plan, rehearse and show; nothing moves")->group(kWay);
  command.add_flag("-y,--yes", choices.yes, "Ask nothing: home, and go on")->group(kWay);
  if (needs == nullptr) return;
  for (CLI::Option* option : command.get_options([](const CLI::Option* one) { return one->get_group() == kWay; }))
    option->needs(needs);
}

}  // namespace

void add_recording(CLI::App& command, io::RecordingOptions& recording) {
  CLI::Option* folder =
      command.add_option("--record", recording.folder, "Keep the log of the connection in this folder")
          ->type_name("FOLDER");
  command.add_flag("!--no-record", recording.records, "Keep no log of the connection")->excludes(folder);
}

void add_machine(CLI::App& command, std::string& machine, io::RecordingOptions& recording) {
  command.add_option("-m,--machine", machine, kMachineHelp)->type_name("URL")->capture_default_str();
  add_recording(command, recording);
}

void add_run(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = kerf.add_subcommand("run", "Cut a G-code file: connect, stream it, show the progress");
  command->add_option("FILE", options->file, "The G-code file")->required()->type_name("");
  add_machine(*command, options->machine, options->recording);
  add_journal(*command, options->recording.journal);
  command->add_flag("--json", options->json, "Print events as JSON, one object a line, instead of the progress");
  command->add_flag("--despite-errors", options->despite_errors,
                    "Start although the check of the program found lines that this machine refuses (docs/check.md)");
  CLI::Option* from_line =
      command
          ->add_option("--from-line", options->start.from_line,
                       "Begin at this line, in the state that the lines before it leave, after a safe way there")
          ->type_name("N")
          ->check(CLI::PositiveNumber);
  add_job_options(*command, options->job);
  add_choices(*command, options->start, from_line);
  command->footer(
      "\nCtrl-C (or Space) holds the machine and asks whether to go on; Ctrl-C again stops the job.\n"
      "Without a terminal SIGUSR1 continues what is held.\n");
  command->callback([&chosen, options] { chosen = [options] { return run(*options); }; });
}

void add_resume(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<ResumeOptions>();
  CLI::App* command = kerf.add_subcommand("resume", "Go on with a job that was interrupted");
  command->add_option("JOB", options->job, "Its number in the list; the newest without it")->type_name("");
  command->add_flag("-l,--list", options->list, "List the jobs that were interrupted, the newest first");
  command->add_option("--file", options->file, "The program, where it is not where it was")->type_name("FILE");
  add_machine(*command, options->machine, options->recording);
  add_journal(*command, options->recording.journal);
  command->add_option("--from-line", options->choices.from_line, "Go on from this line instead")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  add_job_options(*command, options->how);
  add_choices(*command, options->choices, nullptr);
  command->add_flag("--json", options->json, "Print the plan and events as JSON");
  command->footer(
      "\nShows the plan, rehearses it on a virtual machine with these settings and asks before anything moves: "
      "docs/resume.md.\n");
  command->callback([&chosen, options] { chosen = [options] { return resume(*options); }; });
}

void add_audit(CLI::App& kerf, Chosen& chosen) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* command = kerf.add_subcommand("audit", "Find out whether the machine lost steps since it was homed");
  add_machine(*command, options->machine, options->recording);
  add_journal(*command, options->recording.journal);
  command->add_option("--axes", options->axes, "Only these axes, such as XY; Z always comes first where it homes")
      ->type_name("LETTERS");
  command->add_option("--tolerance", options->tolerance_mm, "Differences up to this are the switch's own")
      ->type_name("MM")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--history", options->history, "Only list the audits of before, the newest first");
  command->add_flag("-y,--yes", options->yes, "Do not ask before the machine moves");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->footer(
      "\nMoves the machine to its homing switches, homes it, and compares: docs/audit.md. It asks before anything "
      "moves.\n"
      "Exit status: 0 the position was kept, 4 it was lost, 3 it could not be measured, 5 stopped.\n");
  command->callback([&chosen, options] { chosen = [options] { return audit(*options); }; });
}

}  // namespace kerf::apps
