// `kerf check`: what would go wrong if this program ran on this machine.

#include "rehearsal/check.hpp"

#include <algorithm>
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
#include "common/base/text.hpp"
#include "io/json.hpp"
#include "io/program_file.hpp"
#include "preparation/check_text.hpp"

namespace kerf::apps {
using preparation::check_json;
using preparation::check_text;

namespace {

using rehearsal::CheckMachine;
using rehearsal::CheckPlace;
using rehearsal::CheckResult;

std::optional<CheckMachine> ask_machine(const CheckOptions& options) {
  std::optional<CheckMachine> machine;
  const ExitStatus status = visit(options.machine, {.recording = options.recording}, [&](const io::SessionHost& host) {
    const auto& known = host.session().capabilities();
    if (known.family == vocabulary::Firmware::Unknown) {
      complain("This firmware is not known, so nobody can say what it refuses. Name one with --personality.");
    } else {
      machine.emplace(rehearsal::check_machine_of(known, host.session().snapshot()));
    }
  });
  return status == ExitStatus::Done ? machine : std::nullopt;
}

/// "X,Y,Z"; says what is wrong.
std::optional<std::vector<double>> parse_place(const std::string& text, const char* option) {
  std::vector<double> place;
  for (const std::string_view part : base::split(text, ',')) {
    const auto number = base::parse_decimal(base::trim(part));
    if (!number) {
      complain(fmt::format("'{}' is no place for {}: write one number an axis, such as -100,-200,-50.", text, option));
      return std::nullopt;
    }
    place.push_back(*number);
  }
  return place;
}

std::optional<CheckMachine> described_machine(const CheckOptions& options) {
  CheckPlace place;
  if (!options.zero.empty() && !(place.zero_mm = parse_place(options.zero, "--zero"))) return std::nullopt;
  if (!options.position.empty() && !(place.position_mm = parse_place(options.position, "--position"))) {
    return std::nullopt;
  }
  const auto machine = load_case_machine(options.virtual_machine);
  if (!machine) return std::nullopt;
  return rehearsal::check_machine_of(*machine, place);
}

}  // namespace

ExitStatus check(const CheckOptions& options) {
  const auto file = io::ProgramFile::load(options.file);
  if (!file) {
    complain(io::explain(file.error(), options.file));
    return ExitStatus::Usage;
  }
  const auto machine = options.machine.empty() ? described_machine(options) : ask_machine(options);
  if (!machine) return options.machine.empty() ? ExitStatus::Usage : ExitStatus::NoConnection;
  const CheckResult result = rehearsal::check_program(*file->program(), *machine);
  if (options.json) {
    put("{}\n", io::print(check_json(result, machine->dialect->name)));
  } else {
    for (const std::string& line : check_text(result, options.file, machine->dialect->name)) put("{}\n", line);
  }
  return status_of(result);
}

ExitStatus status_of(const rehearsal::CheckResult& result) {
  if (result.errors > 0) return ExitStatus::Refused;
  return result.warnings > 0 ? ExitStatus::Warned : ExitStatus::Done;
}

}  // namespace kerf::apps
