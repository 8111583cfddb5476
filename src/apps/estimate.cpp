// `kerf estimate`: how long a program takes on this machine, and what the time is spent on.

#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/case_machine.hpp"
#include "apps/commands.hpp"
#include "apps/inquiry.hpp"
#include "apps/output.hpp"
#include "apps/progress_text.hpp"
#include "io/json.hpp"
#include "io/program_file.hpp"
#include "preparation/estimate_grades.hpp"
#include "rehearsal/job_estimate.hpp"
#include "simulation/machine_like.hpp"

namespace kerf::apps {
namespace {

using preparation::Grades;
using rehearsal::JobEstimate;
using rehearsal::LostTime;
using rehearsal::PartEstimate;
using simulation::CaseMachine;

constexpr std::size_t kMostShown = 12;

std::optional<CaseMachine> machine_of(const EstimateOptions& options) {
  if (options.machine.empty()) return load_case_machine(options.virtual_machine);
  std::optional<CaseMachine> machine;
  const ExitStatus status = visit(options.machine, {.recording = options.recording}, [&](const io::SessionHost& host) {
    const auto& known = host.session().capabilities();
    if (known.family == vocabulary::Firmware::Unknown) {
      complain("This firmware is not known, so nobody can say how it moves. Name one with --personality.");
    } else {
      machine.emplace(simulation::machine_like(known));
    }
  });
  return status == ExitStatus::Done ? machine : std::nullopt;
}

std::string metres(double mm) {
  constexpr double kMetre = 1000.0;
  return mm < kMetre ? fmt::format("{:.0f} mm", mm) : fmt::format("{:.2f} m", mm / kMetre);
}

void tell_share(std::string_view name, double seconds, double total_s, const std::string& more = {}) {
  constexpr double kNothing_s = 0.5;
  if (seconds < kNothing_s) return;
  put("  {:<12} {:>9}  {:>3.0f} %{}\n", name, clock_text(seconds), seconds / total_s * 100.0, more);
}

/// In one column, however long CAM programs make it.
std::string shown_name(const std::string& name) {
  constexpr std::size_t kWidth = 36;
  constexpr std::string_view kCut = "...";
  if (name.empty()) return "(before the first)";
  if (name.size() <= kWidth) return name;
  // Not within a letter of UTF-8.
  constexpr unsigned kKind = 0xC0;
  constexpr unsigned kContinues = 0x80;
  std::size_t end = kWidth - kCut.size();
  while (end > 0 && (static_cast<unsigned char>(name[end]) & kKind) == kContinues) --end;
  return name.substr(0, end).append(kCut);
}

void tell_parts(std::string_view title, const std::vector<PartEstimate>& parts, double total_s) {
  if (std::ranges::count_if(parts, [](const PartEstimate& part) { return !part.name.empty(); }) == 0) return;
  put("{}\n", title);
  for (const PartEstimate& part : parts | std::views::take(kMostShown)) {
    put("  {:<36} {:>9}  {:>3.0f} %  {} cut, lines {} to {}\n", shown_name(part.name), clock_text(part.total_s),
        part.total_s / total_s * 100.0, metres(part.cutting_mm), part.first_line, part.last_line);
  }
  if (parts.size() > kMostShown) put("  and {} more: --json has them all\n", parts.size() - kMostShown);
}

void tell_feeds(const JobEstimate& estimate) {
  if (estimate.feeds.size() < 2) return;
  put("Programmed feeds\n");
  for (const auto& bin : estimate.feeds) {
    put("  from {:>6.0f} mm/min {:>9}  {} cut\n", bin.from_mm_per_min, clock_text(bin.total_s), metres(bin.cutting_mm));
  }
}

void tell_world(const Grades& grades, const std::string& link) {
  if (!grades.world) return;
  const double more_s = grades.world->total_s - grades.planner.total_s;
  put("At {} baud: {} ({:+.1f} s).\n", link, clock_text(grades.world->total_s), more_s);
  if (grades.losses.empty()) {
    put("  This link keeps the planner full.\n");
    return;
  }
  put("  This link cannot keep the planner full; the machine slows down, or waits for lines, here:\n");
  for (const LostTime& loss : grades.losses | std::views::take(kMostShown)) {
    put("  lines {} to {}: {:.1f} s\n", loss.first_line, loss.last_line, loss.lost_s);
  }
}

void tell_trouble(const JobEstimate& estimate, std::uint32_t lines) {
  if (!estimate.stops.empty()) {
    put("It waits for the operator at line{} {}; that time is not counted.\n", estimate.stops.size() > 1 ? "s" : "",
        fmt::join(estimate.stops | std::views::take(kMostShown), ", "));
  }
  for (const auto& refused : estimate.errors | std::views::take(kMostShown)) {
    put("Line {} would be refused: error:{} (kerf errors {}).\n", refused.line, refused.code, refused.code);
  }
  if (estimate.errors.size() > kMostShown) put("And {} more lines.\n", estimate.errors.size() - kMostShown);
  for (const int alarm : estimate.alarms) put("ALARM:{} would end the job (kerf alarms {}).\n", alarm, alarm);
  if (estimate.lines_answered < estimate.lines) put("It stops behind line {} of {}.\n", estimate.lines_answered, lines);
}

void tell(const Grades& grades, const EstimateOptions& options, const job::Program& program) {
  const JobEstimate& planner = grades.planner;
  put("{} takes {} with the planner kept full.\n", options.file, clock_text(planner.total_s));
  const double total_s = std::max(planner.total_s, 1e-9);
  tell_share("cutting", planner.use.cutting_s, total_s, "  " + metres(planner.cutting_mm));
  tell_share("rapid", planner.use.rapid_s, total_s, "  " + metres(planner.rapid_mm));
  tell_share("dwell", planner.use.dwell_s, total_s);
  tell_share("tool change", planner.use.tool_change_s, total_s);
  tell_share("standing", planner.use.other_s, total_s);
  tell_parts("Tools", planner.tools, total_s);
  tell_parts("Operations", planner.operations, total_s);
  tell_feeds(planner);
  tell_world(grades, options.link);
  tell_trouble(planner, program.line_count());
}

bool runs_through(const JobEstimate& estimate) {
  return estimate.errors.empty() && estimate.alarms.empty() && estimate.lines_answered == estimate.lines;
}

}  // namespace

ExitStatus estimate(const EstimateOptions& options) {
  const auto link = parse_link(options.link);
  if (!link) return ExitStatus::Usage;
  const auto file = io::ProgramFile::load(options.file);
  if (!file) {
    complain(io::explain(file.error(), options.file));
    return ExitStatus::Usage;
  }
  const auto machine = machine_of(options);
  if (!machine) return options.machine.empty() ? ExitStatus::Usage : ExitStatus::NoConnection;
  const job::Program& program = *file->program();
  const Grades grades = preparation::grades_of(program, *machine, *link);
  if (options.json) {
    put("{}\n", io::print(preparation::estimate_json(grades)));
  } else {
    tell(grades, options, program);
  }
  return runs_through(grades.planner) ? ExitStatus::Done : ExitStatus::Refused;
}

}  // namespace kerf::apps
