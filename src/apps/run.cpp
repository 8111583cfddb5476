#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/job_runner.hpp"
#include "apps/job_view.hpp"
#include "apps/terminal.hpp"
#include "io/program_file.hpp"
#include "preparation/checked_job.hpp"

namespace kerf::apps {
ExitStatus run(const RunOptions& options) {
  if (options.start.from_line) return run_from_line(options);
  const std::unique_ptr<JobView> view = make_view(options.json);
  const auto refuse = [&](const std::string& sentence) {
    view->failed(sentence, ExitStatus::Usage);
    return ExitStatus::Usage;
  };
  const auto url = io::parse_machine_url(options.machine);
  if (!url) return refuse(io::explain(url.error()));
  auto file = io::ProgramFile::load(options.file);
  if (!file) return refuse(io::explain(file.error(), options.file));

  io::EventLoop loop;
  const bool can_ask = !options.json && is_terminal(STDIN_FILENO) && is_terminal(STDOUT_FILENO);
  std::error_code ignored;
  const session::JobOptions job = options.job.settled(can_ask);
  JobRunner runner(
      loop, *url,
      preparation::prepare_checked_job({.program = file->program(),
                                        .origin = {.path = std::filesystem::absolute(options.file, ignored).string()},
                                        .options = job,
                                        .despite_errors = options.despite_errors}),
      job, *view, can_ask);
  return runner.run(options.recording);
}

}  // namespace kerf::apps
