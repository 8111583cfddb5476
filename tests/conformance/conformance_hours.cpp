// Hours of clean jobs without a false alarm, and damaged jobs that are all noticed, on every firmware. A failure prints
// a seed; `--seed` runs it again.

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "simulation/conformance.hpp"

namespace {

using namespace kerf;
using namespace kerf::simulation;
using vocabulary::Firmware;

struct Options {
  double hours = 100;
  std::uint64_t damaged = 300;
  std::uint64_t seed = 1;
  bool one_seed = false;
  bool prints = false;
  std::string firmware;
};

constexpr struct {
  std::string_view name;
  Firmware firmware;
} kFirmwares[] = {{"grbl", Firmware::Grbl}, {"rabbit", Firmware::Rabbit}, {"grblhal", Firmware::GrblHal}};

/// False after a false alarm or a job that did not end.
bool run_clean(std::string_view name, Firmware firmware, const Options& options) {
  CleanRun total;
  std::size_t jobs = 0;
  std::size_t gaps = 0;
  bool passed = true;
  for (std::uint64_t seed = options.seed; total.hours < options.hours; ++seed) {
    const CleanRun run = clean_run(firmware, seed, options.one_seed && options.prints);
    total.hours += run.hours;
    total.lines += run.lines;
    total.reports += run.reports;
    ++jobs;
    if (run.gap && ++gaps <= 10)
      std::printf("%s seed %llu not watched: %s\n", name.data(), static_cast<unsigned long long>(seed),
                  run.gap->c_str());
    if (run.false_alarm)
      std::printf("%s seed %llu FALSE ALARM: %s\n", name.data(), static_cast<unsigned long long>(seed),
                  run.false_alarm->c_str());
    if (run.unfinished)
      std::printf("%s seed %llu did not end: %s\n", name.data(), static_cast<unsigned long long>(seed),
                  run.unfinished->c_str());
    std::fflush(stdout);
    passed = passed && !run.false_alarm && !run.unfinished;
    if (options.one_seed && options.prints) std::printf("%s\n%s", run.program.c_str(), run.conversation.c_str());
    if (options.one_seed) break;
  }
  std::printf("%s: %.1f clean hours, %zu jobs, %zu lines, %zu reports, %zu jobs not watched to their end: %s\n",
              name.data(), total.hours, jobs, total.lines, total.reports, gaps, passed ? "no false alarm" : "FAILED");
  return passed;
}

bool run_damaged(std::string_view name, Firmware firmware, const Options& options) {
  std::size_t ends[5] = {};
  double worst_s = 0;
  for (std::uint64_t i = 0; i < options.damaged; ++i) {
    const std::uint64_t seed = options.seed + i;
    const DamagedRun run = damaged_run(firmware, seed, options.one_seed && options.prints);
    ++ends[static_cast<std::size_t>(run.end)];
    if (run.end == DamagedRunEnd::Held) worst_s = std::max(worst_s, base::to_seconds(run.noticed_after));
    if (run.end == DamagedRunEnd::Missed || options.one_seed) {
      std::printf("%s seed %llu %s after %.3f s, %d reports: %s %s\n", name.data(),
                  static_cast<unsigned long long>(seed), run.end == DamagedRunEnd::Missed ? "MISSED" : "ended",
                  base::to_seconds(run.noticed_after), run.reports, run.damage.c_str(), run.said.c_str());
      std::fflush(stdout);
    }
    if (options.one_seed && options.prints) std::printf("%s\n%s", run.program.c_str(), run.conversation.c_str());
    if (options.one_seed) break;
  }
  std::printf(
      "%s: %llu damaged jobs: %zu kept to the path, %zu refused, %zu held (worst after %.3f s), %zu back on the path "
      "between two reports, "
      "%zu missed\n",
      name.data(), static_cast<unsigned long long>(options.damaged), ends[0], ends[1], ends[2], worst_s, ends[3],
      ends[4]);
  return ends[4] == 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view key = argv[i];
    if (key == "--hours") options.hours = std::strtod(argv[i + 1], nullptr);
    if (key == "--damaged") options.damaged = std::strtoull(argv[i + 1], nullptr, 10);
    if (key == "--firmware") options.firmware = argv[i + 1];
    if (key == "--seed") {
      options.seed = std::strtoull(argv[i + 1], nullptr, 10);
      options.one_seed = true;
    }
    if (key == "--print") options.prints = std::string_view{argv[i + 1]} == "yes";
    if (key == "--from-seed") options.seed = std::strtoull(argv[i + 1], nullptr, 10);
  }
  bool passed = true;
  for (const auto& [name, firmware] : kFirmwares) {
    if (!options.firmware.empty() && options.firmware != name) continue;
    if (options.hours > 0) passed = run_clean(name, firmware, options) && passed;
    if (options.damaged > 0) passed = run_damaged(name, firmware, options) && passed;
  }
  return passed ? EXIT_SUCCESS : EXIT_FAILURE;
}
