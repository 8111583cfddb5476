// Small programs with planted faults, and clean ones of many CAM systems: what `kerf check` finds in them, and whether
// the virtual controller does just that.
//
// Directives of a program, in comments at its head:
//   ; on: grbl rabbit grblhal        the firmwares that it is for; all of them without it
//   ; set: $20=1 $N0=G0X0            settings besides the usual ones
//   ; zero: X Y Z | none             machine position of G54, where somebody knows it
//   ; at: X Y Z                      machine position of the tool; else where homing leaves it
//   ; surface: Z                     what the virtual machine's probe touches, machine coordinates
// In a line: `; finds: SEVERITY KIND [CODE]`, as often as there are findings; before a `$` line, which has no comments,
// `; next finds: ...`.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/text.hpp"
#include "rehearsal/check.hpp"
#include "rehearsal/sent_lines.hpp"
#include "simulation/dice.hpp"
#include "simulation/milling_job.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::rehearsal {
namespace {

using simulation::CaseMachine;
using simulation::MotionTrace;
using vocabulary::Firmware;

const std::filesystem::path kCorpus{KERF_CORPUS};
/// The homing switch of Z lies so far above the place where the virtual machine is switched on.
constexpr double kHomeAboveStartMm = 80;

struct Expected {
  std::uint32_t line = 0;
  std::string severity;
  std::string kind;
  std::string code;
  auto operator<=>(const Expected&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Expected& one) {
  return out << "line " << one.line << ": " << one.severity << ' ' << one.kind << ' ' << one.code;
}

/// A program with its directives.
struct Sample {
  std::string text;
  std::vector<std::string> personalities{"grbl", "rabbit", "grblhal"};
  std::map<std::string, std::string> settings;
  std::vector<double> zero_mm{-200, -200, -40};
  std::vector<double> at_mm;
  std::optional<double> surface_mm;
  std::vector<Expected> expected;
};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& word : words_of(text)) {
    if (const auto number = base::parse_decimal(word)) numbers.push_back(*number);
  }
  return numbers;
}

void read_directive(Sample& sample, const std::string& name, const std::string& value) {
  if (name == "on") sample.personalities = words_of(value);
  if (name == "zero") sample.zero_mm = numbers_of(value);
  if (name == "at") sample.at_mm = numbers_of(value);
  if (name == "surface") sample.surface_mm = numbers_of(value).at(0);
  if (name != "set") return;
  for (const std::string& one : words_of(value)) {
    const std::size_t equals = one.find('=');
    sample.settings[one.substr(1, equals - 1)] = one.substr(equals + 1);
  }
}

void read_expected(Sample& sample, std::uint32_t line, const std::string& text, const std::string& mark) {
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::string rest = text.substr(at + mark.size());
    const auto words = words_of(rest.substr(0, rest.find(';')));
    // A startup line is no line of the file.
    const bool is_of_controller = words.at(1) == "StartupLine";
    sample.expected.push_back({.line = is_of_controller ? 0 : line,
                               .severity = words.at(0),
                               .kind = words.at(1),
                               .code = words.size() > 2 ? words[2] : ""});
  }
}

Sample load(const std::filesystem::path& path) {
  Sample sample;
  std::ifstream file(path);
  std::uint32_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    sample.text += line + "\n";
    read_expected(sample, number, line, "; finds: ");
    read_expected(sample, number + 1, line, "; next finds: ");
    const std::size_t colon = line.find(": ");
    if (line.starts_with("; ") && colon != std::string::npos) {
      read_directive(sample, line.substr(2, colon - 2), line.substr(colon + 2));
    }
  }
  std::ranges::sort(sample.expected);
  return sample;
}

CaseMachine machine_for(const Sample& sample, const std::string& personality) {
  CaseMachine machine{.personality = *firmware::personality_named(personality)};
  firmware::StoredState& stored = machine.stored;
  stored.initialised = true;
  stored.settings = {{"1", "255"},   {"22", "1"},    {"23", "0"},     {"30", "24000"}, {"31", "0"},     {"100", "100"},
                     {"101", "100"}, {"102", "100"}, {"110", "6000"}, {"111", "6000"}, {"112", "3000"}, {"120", "500"},
                     {"121", "500"}, {"122", "500"}, {"130", "400"},  {"131", "300"},  {"132", "80"}};
  for (const auto& [key, value] : sample.settings) {
    if (key.starts_with('N')) {
      stored.startup_lines.at(key == "N1" ? 1 : 0) = value;
    } else {
      stored.settings[key] = value;
    }
  }
  if (!sample.zero_mm.empty()) stored.offsets["G54"] = sample.zero_mm;
  return machine;
}

std::string name_of(Severity severity) {
  switch (severity) {
    case Severity::Error: return "error";
    case Severity::Warning: return "warning";
    case Severity::Note: break;
  }
  return "note";
}

std::vector<Expected> found_in(const CheckResult& result) {
  std::vector<Expected> found;
  for (const FindingGroup& group : result.groups) {
    for (const Finding& finding : group.first) {
      found.push_back({.line = finding.line,
                       .severity = name_of(finding.severity),
                       .kind = boost::describe::enum_to_string(finding.kind, "?"),
                       .code = finding.code});
    }
  }
  std::ranges::sort(found);
  return found;
}

/// Lines before the program: the machine is homed, and goes where the sample has it.
std::vector<std::string> way_to_the_start(const Sample& sample, const CaseMachine& machine) {
  std::vector<std::string> lines;
  if (machine.stored.settings.at("22") != "0") lines.emplace_back("$H");
  if (!sample.at_mm.empty()) {
    std::string place = "G53G0";
    for (std::size_t axis = 0; axis < sample.at_mm.size(); ++axis) {
      place += vocabulary::kAxisLetters[axis] + base::to_fixed(sample.at_mm[axis], 3);
    }
    lines.push_back(place);
  }
  return lines;
}

/// What the controller said to a line of the file, in the words of findings.
using Said = std::vector<std::pair<std::uint32_t, std::string>>;

struct RunOfSample {
  Said said;
  bool is_whole = false;
};

/// The controller runs what Kerf would send of the program, up to `last_line`. A line that raises an alarm is not
/// answered.
RunOfSample run(const job::Program& program, const Sample& sample, CaseMachine machine, std::uint32_t last_line) {
  if (sample.surface_mm) {
    machine.workcell.emplace_back(firmware::ProbeSurfaceMoved{.z_mm = *sample.surface_mm + kHomeAboveStartMm});
  }
  std::string text;
  std::vector<std::uint32_t> file_lines;
  const auto send = [&](std::uint32_t file_line, std::string_view wire) {
    (text += wire) += '\n';
    file_lines.push_back(file_line);
  };
  for (const std::string& line : way_to_the_start(sample, machine)) send(0, line);
  SentLines lines(program, machine.personality.dialect());
  while (const auto line = lines.next()) {
    if (!line->wire.empty() && line->number <= last_line) send(line->number, line->wire);
  }
  const MotionTrace trace = trace_program({.program = text, .operator_goes_on = true}, machine);
  RunOfSample result{.said = {}, .is_whole = trace.lines_answered == trace.lines};
  for (const auto& error : trace.errors) {
    result.said.emplace_back(file_lines.at(error.line - 1), "error:" + std::to_string(error.code));
  }
  for (const int alarm : trace.alarms) {
    result.said.emplace_back(file_lines.at(trace.lines_answered), "ALARM:" + std::to_string(alarm));
  }
  return result;
}

/// The errors among the findings, and where to stop to see the first of them: behind an alarm nobody can tell which
/// line is answered.
Said errors_in(const std::vector<Expected>& found) {
  Said errors;
  for (const Expected& one : found) {
    if (one.severity == "error") errors.emplace_back(one.line, one.code);
  }
  return errors;
}

std::uint32_t last_line_for(const Said& errors) {
  const bool ends_in_alarm = !errors.empty() && errors.front().second.starts_with("ALARM");
  return ends_in_alarm ? errors.front().first : std::numeric_limits<std::uint32_t>::max();
}

void judge(const std::filesystem::path& path, const Sample& sample, const std::string& personality) {
  SCOPED_TRACE(path.filename().string() + " on " + personality);
  const auto program = *job::Program::load(path.filename().string(), sample.text);
  const CaseMachine machine = machine_for(sample, personality);
  CheckPlace place;
  if (!sample.at_mm.empty()) place.position_mm = sample.at_mm;
  const CheckResult result = check_program(*program, check_machine_of(machine, place));
  EXPECT_EQ(found_in(result), sample.expected);

  const Said errors = errors_in(found_in(result));
  const auto [said, is_whole] = run(*program, sample, machine, last_line_for(errors));
  if (errors.empty()) {
    EXPECT_EQ(said, errors);
    EXPECT_TRUE(is_whole);
  } else {
    // grblHAL answers with the same error until it is reset.
    ASSERT_FALSE(said.empty());
    EXPECT_EQ(said.front(), errors.front());
    const bool repeats = machine.personality.dialect().error_latch;
    EXPECT_TRUE(repeats || said == errors);
  }
}

std::vector<std::filesystem::path> programs_in(const char* folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(kCorpus / folder)) {
    if (entry.path().extension() == ".nc") paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

class Corpus : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Corpus, IsJudgedAsItSaysAndAsTheControllerDoes) {
  const Sample sample = load(GetParam());
  const bool is_clean = GetParam().parent_path().filename() == "clean";
  EXPECT_EQ(sample.expected.empty(), is_clean);
  for (const std::string& personality : sample.personalities) judge(GetParam(), sample, personality);
}

/// Jobs as people run them on a machine whose limits lie somewhere near.
TEST(JobsByChance, MeetTheirLimitsWhereTheCheckSaysSo) {
  int beyond = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    for (const std::string personality : {"grbl", "rabbit", "grblhal"}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " on " + personality);
      simulation::Dice dice(seed);
      Sample sample;
      sample.settings = {{"20", "1"}};
      sample.zero_mm = {dice.within(-44, -36), dice.within(-44, -36), dice.within(-14, -8)};
      const CaseMachine machine = machine_for(sample, personality);
      const auto features = simulation::features_of(machine.personality.firmware);
      const auto program = *job::Program::load("job.nc", simulation::milling_job(dice, features, 150));
      const CheckResult result = check_program(*program, check_machine_of(machine));
      const Said errors = errors_in(found_in(result));
      const Said said = run(*program, sample, machine, last_line_for(errors)).said;
      ASSERT_EQ(said.empty(), errors.empty());
      if (said.empty()) continue;
      ++beyond;
      EXPECT_EQ(said.front(), errors.front());
    }
  }
  EXPECT_GT(beyond, 40);
  EXPECT_LT(beyond, 140);
}

std::string name_of_test(const testing::TestParamInfo<std::filesystem::path>& info) {
  return info.param.stem().string();
}

INSTANTIATE_TEST_SUITE_P(Faults, Corpus, testing::ValuesIn(programs_in("faults")), name_of_test);
INSTANTIATE_TEST_SUITE_P(Clean, Corpus, testing::ValuesIn(programs_in("clean")), name_of_test);

TEST(CorpusAsAWhole, HasTwoProgramsForEachKindAndTwentyCleanOnes) {
  const auto faults = programs_in("faults");
  std::map<std::string, int> programs_of_kind;
  for (const auto& path : faults) {
    std::vector<std::string> kinds;
    for (const Expected& one : load(path).expected) kinds.push_back(one.kind);
    std::ranges::sort(kinds);
    const auto repeated = std::ranges::unique(kinds);
    kinds.erase(repeated.begin(), repeated.end());
    for (const std::string& kind : kinds) ++programs_of_kind[kind];
  }
  for (const FindingRow& row : all_finding_rows()) {
    const std::string kind = boost::describe::enum_to_string(row.kind, "?");
    EXPECT_GE(programs_of_kind[kind], 2) << kind;
  }
  EXPECT_GE(faults.size(), 60U);
  EXPECT_GE(programs_in("clean").size(), 20U);
}

}  // namespace
}  // namespace kerf::rehearsal
