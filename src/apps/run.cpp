#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "apps/commands.hpp"
#include "apps/job_runner.hpp"
#include "apps/job_view.hpp"
#include "apps/terminal.hpp"
#include "io/text_file.hpp"
#include "sender/job/program.hpp"

namespace kerf::apps {
namespace {

std::unique_ptr<JobView> view_for(const RunOptions& options) {
  if (options.json) return make_json_view();
  if (is_terminal(STDOUT_FILENO)) return make_terminal_view();
  return make_line_view();
}

}  // namespace

ExitStatus run(const RunOptions& options) {
  const std::unique_ptr<JobView> view = view_for(options);
  const auto refuse = [&](const std::string& sentence) {
    view->failed(sentence, ExitStatus::Usage);
    return ExitStatus::Usage;
  };
  const auto url = io::parse_machine_url(options.machine);
  if (!url) return refuse(io::explain(url.error()));
  auto text = io::read_text_file(options.file);
  if (!text) return refuse(io::explain(text.error(), options.file));
  auto program = job::Program::load(options.file, *std::move(text));
  if (!program) return refuse(job::describe(program.error(), options.file));

  io::EventLoop loop;
  const bool can_ask = !options.json && is_terminal(STDIN_FILENO) && is_terminal(STDOUT_FILENO);
  session::JobOptions job = options.job;
  // Nobody would ever answer.
  if (!can_ask && !options.on_error_chosen) job.on_error = job::ErrorPolicy::Stop;
  std::error_code ignored;
  JobRunner runner(loop, *url, *std::move(program), job, *view, can_ask,
                   {.path = std::filesystem::absolute(options.file, ignored).string()});
  return runner.run(options.recording);
}

}  // namespace kerf::apps
