// How fast Kerf reads, plans and simulates, beside the stock grblHAL simulator if its path is given.
//
//   speed [--rounds N] [--lines N] [--peer SIMULATOR] [--kerf PROGRAM [FILE...]]
//
// Every figure is the median of N rounds; all stages of all programs take their turn within a round, so that a busy
// machine disturbs them alike, and ratios are those of one run. Times are processor time of one thread.

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/vocabulary/dialect.hpp"
#include "measure.hpp"
#include "outside.hpp"
#include "programs.hpp"
#include "stages.hpp"

namespace kerf::bench {
namespace {

struct Options {
  int rounds = 5;
  int lines = 120'000;
  /// The stock simulator is slow: it gets the head of each program.
  int peer_lines = 3'000;
  std::string peer;
  std::string kerf;
  std::vector<std::string> files;
};

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto number = [](const std::string& text, int& value) {
    return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{} && value > 0;
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool has_value = i + 1 < words.size();
    if (words[i] == "--rounds" && has_value && number(words[i + 1], options.rounds)) {
      ++i;
    } else if (words[i] == "--lines" && has_value && number(words[i + 1], options.lines)) {
      ++i;
    } else if (words[i] == "--peer-lines" && has_value && number(words[i + 1], options.peer_lines)) {
      ++i;
    } else if (words[i] == "--peer" && has_value) {
      options.peer = words[++i];
    } else if (words[i] == "--kerf" && has_value) {
      options.kerf = words[++i];
    } else if (!words[i].starts_with("--")) {
      options.files.push_back(words[i]);
    } else {
      return std::nullopt;
    }
  }
  return options;
}

/// One program on one firmware, measured round by round.
struct Row {
  const BenchProgram& program;
  vocabulary::Firmware firmware;
  simulation::CaseMachine machine;
  std::size_t lines = 0;
  std::size_t planned = 0;
  std::size_t blocks = 0;
  double machine_s = 0;
  std::vector<double> parse_s{};
  std::vector<double> plan_s{};
  std::vector<double> simulate_s{};
};

void run_round(Row& row) {
  row.parse_s.push_back(time([&] { static_cast<void>(parse(row.program, row.firmware)); }).cpu_s);
  // Millions of chords: not kept from round to round.
  const auto path = path_of(row.program, row.machine);
  row.planned = path.size();
  row.plan_s.push_back(time([&] { static_cast<void>(plan(path, row.machine)); }).cpu_s);
  row.simulate_s.push_back(time([&] {
                             const auto trace = simulate(row.program, row.machine);
                             row.blocks = trace.blocks.size();
                             row.machine_s = trace.total_s;
                           }).cpu_s);
}

/// "1.23 M", "456 k".
std::string rate(double per_s) {
  char text[32];
  if (per_s >= 1e6) {
    std::snprintf(text, sizeof text, "%.2f M", per_s / 1e6);
  } else {
    std::snprintf(text, sizeof text, per_s >= 1e4 ? "%.0f k" : "%.1f k", per_s / 1e3);
  }
  return text;
}

std::string rate_with_spread(std::size_t count, const std::vector<double>& seconds) {
  const Middle middle = middle_of(seconds);
  char text[64];
  std::snprintf(text, sizeof text, "%8s (%2.0f%%)", rate(static_cast<double>(count) / middle.median).c_str(),
                middle.spread_percent());
  return text;
}

void print(const Row& row) {
  const Middle simulated = middle_of(row.simulate_s);
  std::printf("%-9.*s %-8.*s %8zu %9zu  %s  %s  %s  %7.0f\n", static_cast<int>(row.program.name.size()),
              row.program.name.data(), static_cast<int>(row.machine.personality.dialect().key.size()),
              row.machine.personality.dialect().key.data(), row.lines, row.blocks,
              rate_with_spread(row.lines, row.parse_s).c_str(), rate_with_spread(row.planned, row.plan_s).c_str(),
              rate_with_spread(row.blocks, row.simulate_s).c_str(), row.machine_s / simulated.median);
}

void compare_with_peer(const Options& options, const std::vector<BenchProgram>& programs) {
  std::printf(
      "\nThe stock grblHAL simulator at -t 0, fed by character counting over TCP until Idle, and the virtual\n"
      "grblHAL, with the first %d lines of each program:\n\n"
      "program     blocks     peer s  peer blocks/s     Kerf s  Kerf blocks/s   ratio\n",
      options.peer_lines);
  for (const BenchProgram& whole : programs) {
    const BenchProgram head = head_of(whole, options.peer_lines);
    const auto machine = machine_for(head, vocabulary::Firmware::GrblHal);
    std::vector<double> ours;
    std::size_t blocks = 0;
    for (int round = 0; round < options.rounds; ++round) {
      ours.push_back(time([&] { blocks = simulate(head, machine).blocks.size(); }).wall_s);
    }
    const double kerf_s = middle_of(ours).median;
    const auto peer = run_peer(options.peer, head);
    if (!peer) {
      std::printf("%-9s the simulator did not come to Idle\n", std::string{head.name}.c_str());
      continue;
    }
    std::printf("%-9s %8zu  %9.2f  %13s  %9.4f  %13s  %5.0f x%s\n", std::string{head.name}.c_str(), blocks,
                peer->wall_s, rate(static_cast<double>(blocks) / peer->wall_s).c_str(), kerf_s,
                rate(static_cast<double>(blocks) / kerf_s).c_str(), peer->wall_s / kerf_s,
                peer->refused_lines == 0 ? "" : "  (lines were refused)");
  }
}

void measure_files(const Options& options, const std::vector<BenchProgram>& programs) {
  std::printf(
      "`kerf simulate FILE --json`, the whole process (grblhal):\n\n"
      "file                              wall s    cpu s   peak MB\n");
  std::vector<std::string> files = options.files;
  const ScratchFiles scratch(programs, files);
  for (const std::string& file : files) {
    std::vector<double> wall;
    std::vector<double> cpu;
    double peak_mb = 0;
    for (int round = 0; round < options.rounds; ++round) {
      const auto took = run_process({options.kerf, "simulate", file, "--personality", "grblhal", "--json"});
      if (!took) break;
      wall.push_back(took->wall_s);
      cpu.push_back(took->cpu_s);
      peak_mb = std::max(peak_mb, took->peak_mb);
    }
    if (wall.empty()) {
      std::printf("%-32s could not be simulated\n", file.c_str());
    } else {
      std::printf("%-32s %7.3f  %7.3f  %8.1f\n", file.substr(file.rfind('/') + 1).c_str(), middle_of(wall).median,
                  middle_of(cpu).median, peak_mb);
    }
  }
}

int run(const Options& options) {
  const auto programs = all_programs(options.lines);
  // First, because a child's peak memory counts from this process' own at the fork.
  if (!options.kerf.empty()) measure_files(options, programs);
  std::vector<Row> rows;
  for (const BenchProgram& program : programs) {
    for (const auto* const dialect : vocabulary::all_dialects()) {
      rows.push_back({.program = program,
                      .firmware = dialect->firmware,
                      .machine = machine_for(program, dialect->firmware),
                      .lines = static_cast<std::size_t>(std::ranges::count(program.text, '\n'))});
    }
  }
  std::vector<double> yardsticks;
  double waited = 0;
  for (int round = 0; round < options.rounds; ++round) {
    for (Row& row : rows) {
      const Took yardstick = time_yardstick();
      yardsticks.push_back(yardstick.cpu_s);
      waited += yardstick.wall_s - yardstick.cpu_s;
      run_round(row);
    }
  }
  const Middle yardstick = middle_of(yardsticks);
  std::printf(
      "One thread, processor time, median of %d rounds, in brackets (slowest - fastest) / median.\n"
      "Machine noise: the same arithmetic took %.0f to %.0f ms of processor time (spread %.0f %%), and waited for\n"
      "other processes %.0f %% of the time.\n\n"
      "program   firmware    lines    blocks     parsed lines/s  planned blocks/s     simulated/s  x real time\n",
      options.rounds, yardstick.least * 1e3, yardstick.most * 1e3, yardstick.spread_percent(),
      100 * waited / (waited + yardstick.median * static_cast<double>(yardsticks.size())));
  for (const Row& row : rows) print(row);
  if (!options.peer.empty()) compare_with_peer(options, programs);
  return 0;
}

}  // namespace
}  // namespace kerf::bench

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const auto options = kerf::bench::parse_options(argc, argv);
  if (!options) {
    std::fputs("usage: speed [--rounds N] [--lines N] [--peer SIMULATOR] [--peer-lines N] [--kerf PROGRAM [FILE...]]\n",
               stderr);
    return 1;
  }
  return kerf::bench::run(*options);
}
