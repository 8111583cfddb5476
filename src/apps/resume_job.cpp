// `kerf resume JOB` and `kerf run --from-line`: the job goes on in the middle of its program.

#include <filesystem>
#include <memory>
#include <utility>
#include <variant>

#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/job_runner.hpp"
#include "apps/job_view.hpp"
#include "apps/resume_preparation.hpp"
#include "apps/terminal.hpp"
#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "io/text_file.hpp"

namespace kerf::apps {
namespace {

/// A job may continue another one, which may continue another one; a ring would be a broken journal.
constexpr int kMostContinued = 1000;

template <typename Value>
using Found = std::expected<Value, std::string>;

job::ResumeChoice choice_of(const ResumeChoices& choices) {
  const auto offsets = choices.offsets == "present" ? job::OffsetsChoice::Present
                       : choices.offsets == "job"   ? job::OffsetsChoice::AsThen
                                                    : job::OffsetsChoice::MustAgree;
  return {.from_line = choices.from_line,
          .safe_height_mm = choices.safe_height_mm,
          .plunge_mm_per_min = choices.plunge_mm_per_min,
          .spin_up_s = choices.spin_up_s,
          .offsets = offsets,
          .position_is_confirmed = choices.position_is_right};
}

Found<std::shared_ptr<const job::Program>> load(const std::string& file) {
  auto text = io::read_text_file(file);
  if (!text) return std::unexpected{io::explain(text.error(), file)};
  auto program = job::Program::load(file, *std::move(text));
  if (!program) return std::unexpected{job::describe(program.error(), file)};
  return *std::move(program);
}

bool is_interrupted(const io::JournaledJob& job) {
  return !job.is_running && !job.history.begun.hash.empty() && job.history.outcome() != job::JobOutcome::Complete;
}

Found<io::JournaledJob> find_job(const io::JournalDatabase& journal, std::optional<std::int64_t> number) {
  if (number) {
    auto job = journal.job(*number);
    if (!job) return std::unexpected{"The journal of jobs cannot be read: " + job.error().sentence + "."};
    if (!*job) return std::unexpected{"There is no job " + std::to_string(*number) + "; see kerf resume --list."};
    if ((*job)->is_running) return std::unexpected{"Job " + std::to_string(*number) + " is running."};
    return **std::move(job);
  }
  auto jobs = journal.jobs();
  if (!jobs) return std::unexpected{"The journal of jobs cannot be read: " + jobs.error().sentence + "."};
  // Newest first. The newest job counts: one behind a complete job is history.
  for (io::JournaledJob& job : *jobs) {
    if (job.is_running || job.history.begun.hash.empty()) continue;
    if (is_interrupted(job)) return std::move(job);
    break;
  }
  return std::unexpected{std::string{"The last job was not interrupted; name another one (kerf resume --list)."}};
}

/// The machine before the first line of the file: that of the first job of the chain.
Found<job::MachineAtStart> start_of(const io::JournalDatabase& journal, const job::JobHistory& history) {
  job::JobBegun begun = history.begun;
  for (int i = 0; begun.origin.continues && i < kMostContinued; ++i) {
    auto before = journal.job(*begun.origin.continues);
    if (!before || !*before) {
      return std::unexpected{"Job " + std::to_string(*begun.origin.continues) +
                             ", which this one continues, is not in the journal any more."};
    }
    begun = (*before)->history.begun;
  }
  return begun.machine;
}

ExitStatus carry_out(const std::string& machine, ResumeWish wish, const ResumeChoices& choices, const JobChoices& how,
                     const io::RecordingOptions& recording) {
  const auto url = io::parse_machine_url(machine);
  if (!url) {
    complain(io::explain(url.error()));
    return ExitStatus::Usage;
  }
  // The fault campaign still finds plans that cut what they should not (`make campaign`).
  if (!std::holds_alternative<io::VirtualAddress>(*url) && !choices.dry_run && !choices.trial) {
    complain(
        "Beginning in the middle of a program is on trial: in tests with faults one plan in fifty cut where it should "
        "not. Nothing was sent. --dry-run shows the plan; with --trial it moves the machine: then keep a hand on the "
        "emergency stop, above the work first.");
    return ExitStatus::Usage;
  }
  const bool on_terminal = is_terminal(STDOUT_FILENO);
  const bool can_ask = !wish.json && is_terminal(STDIN_FILENO) && on_terminal;
  const auto view = wish.json ? make_json_view() : on_terminal ? make_terminal_view() : make_line_view();
  io::EventLoop loop;
  JobRunner runner(loop, *url, prepare_resume(std::move(wish)), how.settled(can_ask), *view, can_ask);
  return runner.run(recording);
}

std::string absolute(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::absolute(file, ignored).string();
}

}  // namespace

ExitStatus resume_job(const ResumeOptions& options) {
  const auto refuse = [](const std::string& sentence) {
    complain(sentence);
    return ExitStatus::Usage;
  };
  const std::string path = io::journal_path(options.recording.journal);
  if (path.empty() || !std::filesystem::exists(path)) return refuse("There is no journal of jobs.");
  const auto journal = io::JournalDatabase::open_to_read(path);
  if (!journal) return refuse("The journal of jobs cannot be read: " + journal.error().sentence + ".");
  auto found = find_job(*journal, options.job);
  if (!found) return refuse(found.error());
  const std::string file = options.file.empty() ? found->history.begun.origin.path : options.file;
  if (file.empty()) return refuse("The job came from no file; say where its program is with --file.");
  auto program = load(file);
  if (!program) return refuse(program.error());
  auto start = start_of(*journal, found->history);
  if (!start) return refuse(start.error());
  const std::string machine = options.machine.empty() ? found->machine : options.machine;
  ResumeWish wish{.file = *std::move(program),
                  .path = absolute(file),
                  .work = InterruptedWork{.number = found->number,
                                          .history = std::move(found->history),
                                          .file_start = *std::move(start)},
                  .choice = choice_of(options.choices),
                  .dry_run = options.choices.dry_run,
                  .says_yes = options.choices.yes,
                  .json = options.json};
  return carry_out(machine, std::move(wish), options.choices, options.how, options.recording);
}

ExitStatus run_from_line(const RunOptions& options) {
  auto program = load(options.file);
  if (!program) {
    complain(program.error());
    return ExitStatus::Usage;
  }
  ResumeWish wish{.file = *std::move(program),
                  .path = absolute(options.file),
                  .choice = choice_of(options.start),
                  .dry_run = options.start.dry_run,
                  .says_yes = options.start.yes,
                  .json = options.json};
  return carry_out(options.machine, std::move(wish), options.start, options.job, options.recording);
}

}  // namespace kerf::apps
