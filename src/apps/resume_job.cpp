// `kerf resume JOB` and `kerf run --from-line`: the job goes on in the middle of its program.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/job_runner.hpp"
#include "apps/job_view.hpp"
#include "apps/terminal.hpp"
#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "io/program_file.hpp"
#include "preparation/interrupted_jobs.hpp"
#include "preparation/resume_preparation.hpp"

namespace kerf::apps {
using preparation::prepare_resume;
using preparation::ResumeWish;

namespace {

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

/// The file of the program, which has the line from which it is to go on.
Found<io::ProgramFile> load(const std::string& path, const ResumeChoices& choices) {
  auto file = io::ProgramFile::load(path);
  if (!file) return std::unexpected{io::explain(file.error(), path)};
  const std::uint32_t lines = file->program()->line_count();
  if (choices.from_line.value_or(1) > lines) {
    return std::unexpected{fmt::format("{} has {} lines: there is no line {} to begin at. Choose one with --from-line.",
                                       path, lines, *choices.from_line)};
  }
  return *std::move(file);
}

/// What is the same for both commands.
struct Circumstances {
  const std::string& machine;
  const JobChoices& how;
  const io::RecordingOptions& recording;
  JobView& view;
  bool json = false;

  [[nodiscard]] ExitStatus refuse(const std::string& sentence) const {
    view.failed(sentence, ExitStatus::Usage);
    return ExitStatus::Usage;
  }
};

ExitStatus carry_out(ResumeWish wish, const Circumstances& with) {
  const auto url = io::parse_machine_url(with.machine);
  if (!url) return with.refuse(io::explain(url.error()));
  const bool can_ask = !with.json && is_terminal(STDIN_FILENO) && is_terminal(STDOUT_FILENO);
  io::EventLoop loop;
  JobRunner runner(loop, *url, prepare_resume(std::move(wish)), with.how.settled(can_ask), with.view, can_ask);
  return runner.run(with.recording);
}

std::string absolute(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::absolute(file, ignored).string();
}

}  // namespace

ExitStatus resume_job(const ResumeOptions& options) {
  const auto view = make_view(options.json);
  const auto refuse = [&view](const std::string& sentence) {
    view->failed(sentence, ExitStatus::Usage);
    return ExitStatus::Usage;
  };
  const std::string path = io::journal_path(options.recording.journal);
  if (path.empty() || !std::filesystem::exists(path)) {
    return refuse(
        fmt::format("No job was ever written down{}: there is nothing to resume.", path.empty() ? "" : " in " + path));
  }
  const auto journal = io::JournalDatabase::open_to_read(path);
  if (!journal) return refuse("The journal of jobs cannot be read: " + journal.error().sentence + ".");
  auto found = preparation::find_interrupted_work(*journal, options.job);
  if (!found) return refuse(found.error());
  const std::string file = options.file.empty() ? found->history.begun.origin.path : options.file;
  if (file.empty()) {
    return refuse(fmt::format("Job {} came from no file: say where its program is with --file.", found->number));
  }
  auto program = load(file, options.choices);
  if (!program)
    return refuse(program.error() + (options.file.empty() ? " If it is elsewhere now, name it with --file." : ""));
  const job::JobBegun& begun = found->history.begun;
  const std::string& then = begun.origin.file_hash.empty() ? begun.hash : begun.origin.file_hash;
  if (program->program()->hash() != then) {
    return refuse(fmt::format(
        "{} is not the file that job {} cut: its content has changed since. Put the old one back, or name it with "
        "--file. To cut the new one from some line on: kerf run FILE --from-line N.",
        file, found->number));
  }
  const std::string machine = options.machine.empty() ? found->machine : options.machine;
  ResumeWish wish{.file = *std::move(program),
                  .path = absolute(file),
                  .work = *std::move(found),
                  .choice = choice_of(options.choices),
                  .dry_run = options.choices.dry_run,
                  .says_yes = options.choices.yes};
  return carry_out(std::move(wish), {machine, options.how, options.recording, *view, options.json});
}

ExitStatus run_from_line(const RunOptions& options) {
  const auto view = make_view(options.json);
  auto program = load(options.file, options.start);
  if (!program) {
    view->failed(program.error(), ExitStatus::Usage);
    return ExitStatus::Usage;
  }
  ResumeWish wish{.file = *std::move(program),
                  .path = absolute(options.file),
                  .choice = choice_of(options.start),
                  .dry_run = options.start.dry_run,
                  .says_yes = options.start.yes};
  return carry_out(std::move(wish), {options.machine, options.job, options.recording, *view, options.json});
}

}  // namespace kerf::apps
