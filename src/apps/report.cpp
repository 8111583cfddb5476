// `kerf report`: a page about a job, to look at before it runs and to keep.

#include "rehearsal/report.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/case_machine.hpp"
#include "apps/commands.hpp"
#include "apps/inquiry.hpp"
#include "apps/output.hpp"
#include "common/base/duration_text.hpp"
#include "io/program_file.hpp"
#include "io/wall_clock.hpp"
#include "preparation/check_text.hpp"
#include "rehearsal/plot.hpp"
#include "simulation/machine_like.hpp"

namespace kerf::apps {

namespace {

using rehearsal::PlotOptions;
using rehearsal::PlotView;
using rehearsal::Report;
using simulation::CaseMachine;

/// The machine that runs the job, and what the check may know of it.
struct ReportedMachine {
  CaseMachine virtual_machine;
  rehearsal::CheckMachine facts;
  std::string settings;
};

std::optional<ReportedMachine> described_machine(const CaseMachineOptions& options) {
  const auto machine = load_case_machine(options);
  if (!machine) return std::nullopt;
  return ReportedMachine{
      .virtual_machine = *machine,
      .facts = rehearsal::check_machine_of(*machine),
      .settings = options.settings_file.empty()
                      ? "default settings"
                      : "the settings of " + std::filesystem::path(options.settings_file).filename().string()};
}

std::optional<ReportedMachine> ask_machine(const ReportOptions& options) {
  std::optional<ReportedMachine> machine;
  const ExitStatus status = visit(options.machine, {.recording = options.recording}, [&](const io::SessionHost& host) {
    const auto& known = host.session().capabilities();
    if (known.family == vocabulary::Firmware::Unknown) {
      complain("This firmware is not known, so nobody can say what it does. Name one with --personality.");
      return;
    }
    machine.emplace(ReportedMachine{.virtual_machine = simulation::machine_like(known),
                                    .facts = rehearsal::check_machine_of(known, host.session().snapshot()),
                                    .settings = "the settings of " + options.machine});
  });
  return status == ExitStatus::Done ? std::move(machine) : std::nullopt;
}

void add_pictures(Report& report, std::string_view text, const rehearsal::PathStart& start) {
  constexpr double kWide_px = 764;
  constexpr double kHalf_px = 368;
  const auto options_of = [&report](PlotView view, double width_px, double height_px) {
    return PlotOptions{
        .view = view, .width_px = width_px, .height_px = height_px, .title = report.file.name, .is_sheet = false};
  };
  const std::array wanted{options_of(PlotView::Isometric, kWide_px, 460), options_of(PlotView::Top, kHalf_px, 400),
                          options_of(PlotView::Front, kHalf_px, 190), options_of(PlotView::Side, kHalf_px, 190)};
  auto drawings = rehearsal::plot(text, start, report.path, wanted);
  const std::array captions{"From the front right corner, mm", "From above", "From the front", "From the right"};
  for (std::size_t at = 0; at < drawings.size(); ++at) {
    report.pictures.push_back({.caption = captions.at(at), .drawing = std::move(drawings[at])});
  }
}

}  // namespace

ExitStatus report(const ReportOptions& options) {
  const auto file = io::ProgramFile::load(options.file);
  if (!file) {
    complain(io::explain(file.error(), options.file));
    return ExitStatus::Usage;
  }
  auto machine = options.machine.empty() ? described_machine(options.virtual_machine) : ask_machine(options);
  if (!machine) return options.machine.empty() ? ExitStatus::Usage : ExitStatus::NoConnection;
  const job::Program& program = *file->program();
  const auto start = rehearsal::path_start_of(machine->virtual_machine);
  Report report{.file = {.name = std::filesystem::path(options.file).filename().string(),
                         .hash = program.hash(),
                         .size_bytes = program.size_bytes(),
                         .lines = program.line_count()},
                .firmware = std::string{machine->facts.dialect->name},
                .settings = machine->settings,
                .made_at = io::to_string(io::wall_clock_now()),
                .made_by = "Kerf " KERF_VERSION,
                .machine = machine->facts,
                .path = rehearsal::summarize(program.text(), start),
                .estimate = rehearsal::estimate_job(program, machine->virtual_machine),
                .check = rehearsal::check_program(program, machine->facts),
                .pictures = {}};
  add_pictures(report, program.text(), start);
  const std::string page = rehearsal::to_html(report);
  if (const auto written = io::replace_text_file(options.output, page); !written) {
    complain(io::explain(written.error(), options.output));
    return ExitStatus::Usage;
  }
  put("{}: {} takes {} on this {}; {} errors, {} warnings. Open it in a browser, or print it.\n", options.output,
      options.file, base::clock_text(report.estimate.total_s), report.firmware, report.check.errors,
      report.check.warnings);
  return status_of(report.check);
}

}  // namespace kerf::apps
