#include "simulation/resume_rehearsal.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/base/text.hpp"
#include "common/gcode/modal_words.hpp"
#include "sender/job/program_state.hpp"
#include "sender/job/resume_test_job.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/machine/controller_rules.hpp"
#include "simulation/case_runner.hpp"
#include "simulation/machine_like.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::simulation {
namespace {

using vocabulary::Firmware;

rc::Gen<Firmware> any_firmware() {
  return rc::gen::element(Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal);
}

std::string number(int from, int to) {
  const int hundredths = *rc::gen::inRange(from * 10, to * 10);
  return base::to_fixed(hundredths / 10.0, 1);
}

/// One line of a milling program; `depth` and units are kept sane by small numbers.
std::string any_line(bool is_incremental) {
  const auto at = [&](int most) { return is_incremental ? number(-2, 2) : number(0, most); };
  switch (*rc::gen::inRange(0, 17)) {
    case 0: return "G0Z5";
    case 1: return "G1Z-" + number(0, 4) + "F" + number(100, 400);
    case 2: return "X" + at(60);
    case 3: return "Y" + at(60);
    case 4: return "X" + at(60) + "Y" + at(60);
    case 5: return "G1X" + at(60) + "F" + number(300, 900);
    case 6: return "G90G0X20Y20\nG2X30Y20I5J0F500\nG1";
    case 7: return "G90G0X20Y20\nG3X20Y30I0J5F500\nX20Y40I0J5\nG1";
    case 8: return "M3S" + number(100, 900);
    case 9: return "M8";
    case 10: return "M9";
    case 11: return "G55";
    case 12: return "G54";
    case 13: return "G90G43.1Z" + number(0, 3);
    case 14: return "G93\nG1X" + at(60) + "F20\nG94F500";
    case 15: return "G90G0X10Y10\nG92X" + number(9, 12);
    default: return "G4P0.1";
  }
}

std::vector<std::string> any_program() {
  std::vector<std::string> lines{"G21G90G54G17", "M3S1000", "G0Z5", "G0X10Y10", "G1Z-1F200", "F600"};
  bool is_incremental = false;
  const int count = *rc::gen::inRange(5, 24);
  for (int i = 0; i < count; ++i) {
    const bool was = is_incremental;
    if (*rc::gen::inRange(0, 6) == 0) is_incremental = !is_incremental;
    if (was != is_incremental) lines.emplace_back(is_incremental ? "G91" : "G90");
    const std::string text = any_line(is_incremental);
    for (const auto line : base::split(text, '\n')) lines.emplace_back(line);
    if (text.contains("G90")) is_incremental = false;
  }
  return lines;
}

job::MachineAtStart switched_on(Firmware firmware) {
  job::MachineAtStart machine = job::testing::router(firmware);
  machine.machine_position_mm = std::vector<double>{0, 0, 0};
  machine.offsets_mm["G55"] = {-190, -140, -58};
  return machine;
}

machine::Capabilities capabilities_of(Firmware firmware) {
  machine::Capabilities capabilities = job::testing::settings_of_router(firmware);
  for (const char* const id : {"100", "101", "102"}) {
    capabilities.settings.push_back({.id = id, .value = std::string{"250.000"}});
  }
  return capabilities;
}

machine::Snapshot snapshot_of(const job::MachineAtStart& machine) {
  machine::Snapshot now;
  now.offsets_mm = machine.offsets_mm;
  now.machine_position_mm = machine.machine_position_mm;
  now.tool_length = machine.tool_length;
  return now;
}

CaseMachine virtual_machine(Firmware firmware) {
  CaseMachine machine = machine_like(capabilities_of(firmware));
  machine.stored.offsets["G54"] = {-200, -150, -60};
  machine.stored.offsets["G55"] = {-190, -140, -58};
  return machine;
}

std::string joined(const std::vector<std::string>& lines, std::size_t from = 0) {
  std::string text;
  for (std::size_t i = from; i < lines.size(); ++i) (text += lines[i]) += '\n';
  return text;
}

job::ProgramState read(Firmware firmware, const std::vector<std::string>& lines) {
  const auto start =
      job::program_start_of(switched_on(firmware), machine::interpreter_settings_of(capabilities_of(firmware)));
  job::ProgramState state(*job::interpreter_at(*start), *start->dialect);
  for (std::size_t i = 0; i < lines.size(); ++i) state.execute(static_cast<std::uint32_t>(i + 1), lines[i]);
  return state;
}

RC_GTEST_PROP(ProgramState, IsWhatTheControllerSaysOfItself, ()) {
  const Firmware firmware = *any_firmware();
  const std::vector<std::string> program = any_program();
  const auto count = *rc::gen::inRange<std::size_t>(0, program.size() + 1);
  const std::vector<std::string> lines(program.begin(), program.begin() + static_cast<std::ptrdiff_t>(count));
  const job::ProgramState state = read(firmware, lines);
  const CaseRecord record = run_case({.id = "state", .lines = lines}, virtual_machine(firmware));
  for (const std::string& answer : record.answers) RC_ASSERT(answer == "ok");
  RC_ASSERT(!state.doubt());

  std::string modes;
  gcode::append_modal_words(state.parser(), state.offsets(), state.reader().rules(), {}, modes);
  RC_LOG() << joined(lines);
  RC_ASSERT(record.parser_state.contains(modes));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    RC_ASSERT(std::abs(record.position_mm[axis] - static_cast<double>(state.parser().position_mm.at(axis))) < 0.005);
  }
  for (const auto& [name, value] : record.offsets) {
    const auto numbers = base::split(value, ',');
    const auto same = [&](const vocabulary::AxisValues& values) {
      for (std::size_t axis = 0; axis < numbers.size(); ++axis) {
        const auto told = base::parse_decimal(numbers[axis]).value_or(1e9);
        RC_ASSERT(std::abs(told - static_cast<double>(values.at(axis))) < 0.0015);
      }
    };
    if (name == "G54") same(state.offsets().work[0]);
    if (name == "G55") same(state.offsets().work[1]);
    if (name == "G92") same(state.offsets().g92);
  }
}

std::vector<vocabulary::AxisSteps> ends_of(const MotionTrace& trace, std::size_t first_line) {
  std::vector<vocabulary::AxisSteps> ends;
  for (const BlockTrace& block : trace.blocks) {
    if (block.line >= first_line) ends.push_back(block.end_steps);
  }
  return ends;
}

/// Blocks that the float's last digit made or left out stand still; the path is the places, not their number.
void drop_standstill(std::vector<vocabulary::AxisSteps>& ends) {
  const auto close = [](const vocabulary::AxisSteps& a, const vocabulary::AxisSteps& b) {
    return std::ranges::equal(a, b, [](int one, int other) { return std::abs(one - other) <= 1; });
  };
  ends.erase(std::unique(ends.begin(), ends.end(), close), ends.end());
}

RC_GTEST_PROP(Resume, CutsTheRestAsTheUninterruptedJob, ()) {
  const Firmware firmware = *any_firmware();
  const std::vector<std::string> lines = any_program();
  const auto file = *job::Program::load("part.nc", joined(lines));
  const auto from = *rc::gen::inRange<std::uint32_t>(8, static_cast<std::uint32_t>(lines.size()) + 1);
  RC_LOG() << "from line " << from << "\n" << joined(lines);

  job::MachineAtStart present = switched_on(firmware);
  present.machine_position_mm = std::vector<double>{-1, -1, -1};
  const job::ResumeFacts facts{.start = switched_on(firmware),
                               .present = present,
                               .capabilities = capabilities_of(firmware),
                               .executing = {.from = from, .to = from, .known_by = job::ExecutingKnownBy::LineNumber}};
  const auto plan = job::plan_resume(*file, facts, {});
  if (!plan) RC_LOG() << plan.error().sentence;
  RC_ASSERT(plan.has_value());
  const auto rehearsal = rehearse_resume(*file, *plan, snapshot_of(present), facts.capabilities);
  if (!rehearsal) RC_LOG() << rehearsal.error().sentence;
  RC_ASSERT(rehearsal.has_value());
  RC_ASSERT(rehearsal->is_whole);

  const auto resumed = job::resumed_program(*file, *plan);
  const MotionTrace whole = trace_program({.program = joined(lines)}, virtual_machine(firmware));
  RC_ASSERT(whole.errors.empty());
  CaseMachine machine = virtual_machine(firmware);
  const std::vector<std::string> preamble = plan->preamble();
  const MotionTrace part = trace_program({.program = joined(preamble) + joined(lines, plan->from_line - 1)}, machine);
  auto expected = ends_of(whole, plan->from_line);
  auto found = ends_of(part, preamble.size() + 1);
  if (plan->rewritten) {
    std::string text = joined(preamble);
    for (std::uint32_t n = plan->from_line; n <= lines.size(); ++n) {
      (text += n == plan->rewritten->line ? plan->rewritten->text : lines[n - 1]) += '\n';
    }
    found = ends_of(trace_program({.program = text}, machine), preamble.size() + 1);
  }
  drop_standstill(expected);
  drop_standstill(found);
  RC_ASSERT(expected.size() == found.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) RC_ASSERT(std::abs(expected[i].at(axis) - found[i].at(axis)) <= 2);
  }
  // Lines keep their numbers in the program that is sent.
  if (resumed.origin.preamble_lines == plan->from_line - 1) RC_ASSERT(resumed.program->line_count() == lines.size());
}

TEST(ResumeRehearsal, SaysWhatTheControllerWouldRefuse) {
  const std::string text = "G21G90\nM3S100\nG1X1F100\nX2\nX3\nG999\n";
  const auto file = *job::Program::load("part.nc", text);
  job::ResumeFacts facts{.start = switched_on(Firmware::Grbl),
                         .present = switched_on(Firmware::Grbl),
                         .capabilities = capabilities_of(Firmware::Grbl)};
  const auto plan = job::plan_resume(*file, facts, {.from_line = 5});
  ASSERT_TRUE(plan);
  const auto rehearsal = rehearse_resume(*file, *plan, snapshot_of(facts.present), facts.capabilities);
  ASSERT_FALSE(rehearsal);
  EXPECT_EQ(rehearsal.error().line, 6U);
}

}  // namespace
}  // namespace kerf::simulation
