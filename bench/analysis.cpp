// How fast a program is opened and understood, however long it is, beside what any program would have to do.
//
//   analysis [--rounds N] [--megabytes N,N,...] [--personality KEY]
//
// For each shape of program and each size: a scan for line ends with memchr, the least tokeniser (letters and numbers
// into a sum), Kerf's own loading (checks, index, content hash), its full interpretation, its planner, and the whole
// check that `kerf run` makes before it begins. Every figure is the median of N rounds of processor time on one thread;
// all stages take their turn within a round, so that a busy machine disturbs them alike, and only ratios say something.
// The memory of loading and check is what they hold on the heap, looked at after each megabyte.

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <malloc.h>

#include "measure.hpp"
#include "programs.hpp"
#include "rehearsal/check.hpp"
#include "sender/job/program.hpp"
#include "stages.hpp"

namespace kerf::bench {
namespace {

constexpr std::size_t kMegabyte = 1'000'000;

struct Options {
  int rounds = 3;
  std::vector<std::size_t> megabytes = {10, 100};
  vocabulary::Firmware firmware = vocabulary::Firmware::GrblHal;
};

std::size_t scan_with_memchr(std::string_view text) {
  std::size_t lines = 0;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (const void* found = std::memchr(at, '\n', static_cast<std::size_t>(end - at))) {
    ++lines;
    at = static_cast<const char*>(found) + 1;
  }
  return lines;
}

/// Letters and decimal numbers, nothing checked.
double tokenise(std::string_view text) {
  double sum = 0;
  for (const char *at = text.data(), *const end = at + text.size(); at < end;) {
    const char letter = *at++;
    if (letter < 'A' || letter > 'Z') continue;
    double value = 0;
    at = std::from_chars(at, end, value).ptr;
    sum += value + static_cast<double>(letter);
  }
  return sum;
}

std::size_t load(std::string_view text) {
  const auto program = job::Program::load("bench.nc", nullptr, text);
  return program ? (*program)->line_count() : 0;
}

std::size_t heap_bytes() {
  const auto counts = ::mallinfo2();
  return counts.uordblks + counts.hblkhd;
}

struct Checked {
  double seconds = 0;
  std::uint64_t errors = 0;
  /// What program and check held together, at most.
  std::size_t most_bytes = 0;
};

/// The check alone is timed, not the loading before it.
Checked check(std::string_view text, const simulation::CaseMachine& machine) {
  Checked checked;
  const std::size_t before = heap_bytes();
  const auto program = job::Program::load("bench.nc", nullptr, text);
  if (!program) return checked;
  checked.seconds = time([&] {
                      rehearsal::Checker checker(**program, rehearsal::check_machine_of(machine));
                      while (checker.read_on(kMegabyte)) {
                        checked.most_bytes = std::max(checked.most_bytes, heap_bytes() - before);
                      }
                      checked.errors = checker.finish().errors;
                    }).cpu_s;
  return checked;
}

/// A program of about `bytes`: the shape's head, and its body as often as it takes.
BenchProgram stretched(const BenchProgram& shape, std::size_t bytes) {
  BenchProgram program = shape;
  const std::size_t tail = program.text.rfind("M5\n");
  const std::string end = program.text.substr(tail);
  program.text.resize(tail);
  const std::string once = program.text;
  program.text.reserve(bytes + once.size());
  while (program.text.size() + once.size() < bytes) program.text += once;
  program.text += end;
  return program;
}

struct Stage {
  std::string_view name;
  std::vector<double> seconds{};
};

void measure(const BenchProgram& program, const Options& options) {
  const std::string_view text = program.text;
  const auto lines = static_cast<double>(scan_with_memchr(text));
  const auto machine = machine_for(program, options.firmware);
  Stage scan{"memchr scan"};
  Stage tokens{"least tokeniser"};
  Stage index{"load and index"};
  Stage read{"full interpretation"};
  Stage planned{"planner"};
  Stage whole{"whole check"};
  Checked checked;
  double sink = 0;
  std::size_t blocks = 0;
  for (int round = 0; round < options.rounds; ++round) {
    scan.seconds.push_back(time([&] { sink += static_cast<double>(scan_with_memchr(text)); }).cpu_s);
    tokens.seconds.push_back(time([&] { sink += tokenise(text); }).cpu_s);
    index.seconds.push_back(time([&] { sink += static_cast<double>(load(text)); }).cpu_s);
    read.seconds.push_back(time([&] { sink += static_cast<double>(parse(program, options.firmware)); }).cpu_s);
    planned.seconds.push_back(time([&] { blocks = plan_whole(program, machine); }).cpu_s);
    checked = check(text, machine);
    whole.seconds.push_back(checked.seconds);
  }
  const double scan_s = middle_of(scan.seconds).median;
  for (const Stage* const stage : {&scan, &tokens, &index, &read, &planned, &whole}) {
    const double seconds = middle_of(stage->seconds).median;
    std::printf("%-10.*s %6.0f MB  %-20.*s %8.3f s  %6.2f GB/s  %7.2f M lines/s  %6.2f of the scan",
                static_cast<int>(program.name.size()), program.name.data(),
                static_cast<double>(text.size()) / kMegabyte, static_cast<int>(stage->name.size()), stage->name.data(),
                seconds, static_cast<double>(text.size()) / seconds / 1e9, lines / seconds / 1e6, scan_s / seconds);
    if (stage == &planned) std::printf("  %.2f M blocks/s", static_cast<double>(blocks) / seconds / 1e6);
    if (stage == &whole) {
      std::printf("  %.2f bytes of memory a line, %llu errors found", static_cast<double>(checked.most_bytes) / lines,
                  static_cast<unsigned long long>(checked.errors));
    }
    std::printf("\n");
  }
  if (sink < 0) std::printf("impossible\n");
}

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  const std::vector<std::string_view> words(argv + 1, argv + argc);
  const auto number = [](std::string_view text, auto& value) {
    return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{} && value > 0;
  };
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    std::string_view value = words[i + 1];
    if (words[i] == "--rounds") {
      if (!number(value, options.rounds)) return std::nullopt;
    } else if (words[i] == "--megabytes") {
      options.megabytes.clear();
      for (;;) {
        const std::size_t comma = value.find(',');
        if (!number(value.substr(0, comma), options.megabytes.emplace_back())) return std::nullopt;
        if (comma == std::string_view::npos) break;
        value.remove_prefix(comma + 1);
      }
    } else if (words[i] == "--personality") {
      const auto& dialects = vocabulary::all_dialects();
      const auto found = std::ranges::find(dialects, value, [](const auto* dialect) { return dialect->key; });
      if (found == dialects.end()) return std::nullopt;
      options.firmware = (*found)->firmware;
    } else {
      return std::nullopt;
    }
  }
  return words.size() % 2 == 0 ? std::optional{options} : std::nullopt;
}

}  // namespace
}  // namespace kerf::bench

int main(int argc, char** argv) {
  const auto options = kerf::bench::parse_options(argc, argv);
  if (!options) {
    std::fputs("usage: analysis [--rounds N] [--megabytes N,N,...] [--personality grbl|rabbit|grblhal]\n", stderr);
    return 2;
  }
  for (const auto& shape : kerf::bench::all_programs(120'000)) {
    for (const std::size_t megabytes : options->megabytes) {
      kerf::bench::measure(kerf::bench::stretched(shape, megabytes * kerf::bench::kMegabyte), *options);
    }
  }
  return 0;
}
