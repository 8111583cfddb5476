// `kerf simulate`: runs a file on a virtual machine as fast as it can, and tells when what happens.

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/case_machine.hpp"
#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "io/json.hpp"
#include "io/text_file.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::apps {
namespace {

using io::Json;
using simulation::MotionTrace;
using simulation::ProgramRun;

std::optional<ProgramRun> load_run(const SimulateOptions& options) {
  const auto link = parse_link(options.link);
  auto inject = parse_injections(options.inject);
  if (!link || !inject) return std::nullopt;
  if (!(options.every_s > 0)) {
    complain("--every is a number of seconds above 0, such as 0.01.");
    return std::nullopt;
  }
  auto program = io::read_text_file(options.file);
  if (!program) {
    complain(io::explain(program.error(), options.file));
    return std::nullopt;
  }
  ProgramRun run{.program = *std::move(program),
                 .link = *link,
                 .inject = *std::move(inject),
                 .keeps_blocks = !options.trace_file.empty()};
  if (!options.positions_file.empty()) run.sample_every = base::from_seconds(options.every_s);
  return run;
}

std::string joined(std::span<const std::int32_t> steps) {
  std::string text;
  for (const std::int32_t count : steps) text += fmt::format(",{}", count);
  return text;
}

std::string step_columns(std::size_t axes, const char* name) {
  std::string text;
  for (std::size_t axis = 0; axis < axes; ++axis) text += fmt::format(",{}_{}", name, axis);
  return text;
}

bool write(const std::string& file, const std::string& text) {
  const auto written = io::replace_text_file(file, text);
  if (!written) complain(io::explain(written.error(), file));
  return written.has_value();
}

bool write_trace(const MotionTrace& trace, const std::string& file) {
  const std::size_t axes = trace.final_steps.size();
  std::string text = "block,line,t_start,t_end,mm,rate_mm_min" + step_columns(axes, "end_step") + "\n";
  for (std::size_t i = 0; i < trace.blocks.size(); ++i) {
    const auto& block = trace.blocks[i];
    text += fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.3f}{}\n", i, block.line, block.start_s, block.end_s,
                        block.length_mm, block.rate_mm_per_min, joined(std::span{block.end_steps}.first(axes)));
  }
  return write(file, text);
}

bool write_positions(const MotionTrace& trace, const std::string& file) {
  std::string text;
  for (const auto& sample : trace.positions) text += fmt::format("{:.5f}{}\n", sample.at_s, joined(sample.steps));
  return write(file, text);
}

Json as_json(const MotionTrace& trace) {
  Json errors = Json::array();
  for (const auto& refused : trace.errors) errors.push_back({{"line", refused.line}, {"code", refused.code}});
  constexpr double kMicroseconds = 1e6;
  Json json = Json::object();
  json["total_s"] = std::round(trace.total_s * kMicroseconds) / kMicroseconds;
  json["blocks"] = trace.block_count;
  json["final_steps"] = trace.final_steps;
  json["final_mm"] = trace.final_mm;
  json["errors"] = std::move(errors);
  json["alarms"] = trace.alarms;
  json["lines"] = trace.lines;
  json["lines_answered"] = trace.lines_answered;
  return json;
}

void tell(const MotionTrace& trace, const std::string& file) {
  put("{} takes {:.3f} s: {} blocks, from {} of {} lines.\n", file, trace.total_s, trace.block_count,
      trace.lines_answered, trace.lines);
  std::string place;
  for (const double mm : trace.final_mm) place += fmt::format("{}{:.3f}", place.empty() ? "" : ", ", mm);
  put("The machine stands at {} mm in the end.\n", place);
  for (const auto& refused : trace.errors) put("Line {} was refused: error:{}.\n", refused.line, refused.code);
  for (const int alarm : trace.alarms) put("ALARM:{} was raised.\n", alarm);
}

}  // namespace

ExitStatus simulate(const SimulateOptions& options) {
  const auto machine = load_case_machine(options.machine);
  if (!machine) return ExitStatus::Usage;
  const auto run = load_run(options);
  if (!run) return ExitStatus::Usage;
  const MotionTrace trace = simulation::trace_program(*run, *machine);
  if (!options.trace_file.empty() && !write_trace(trace, options.trace_file)) return ExitStatus::Usage;
  if (!options.positions_file.empty() && !write_positions(trace, options.positions_file)) return ExitStatus::Usage;
  if (options.json) {
    put("{}\n", io::print(as_json(trace)));
  } else {
    tell(trace, options.file);
  }
  return ExitStatus::Done;
}

}  // namespace kerf::apps
