// How fast `kerf run` streams, how full it keeps a serial wire, how soon a feed hold leaves it and how much memory a
// long job takes: beside the least program that can do character counting, in the same run.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "measure.hpp"
#include "wires.hpp"

namespace kerf::bench {
namespace {

using std::chrono::milliseconds;

constexpr int kBaud = 115'200;
constexpr std::size_t kWindow = 127;
constexpr const char* kKerf = "kerf";
constexpr const char* kFloor = "floor";
constexpr double kBytesAMegabyte = 1e6;

struct Options {
  std::string kerf;
  std::string floor;
  std::string what = "all";
  int rounds = 5;
  long lines = 400'000;
  int tries = 200;
  long megabytes = 1000;
};

/// Short moves over a square, every line 12 bytes as Kerf would send it: no digit that could be left out.
void write_job(const std::string& path, long lines, std::string_view comment) {
  std::ofstream file(path, std::ios::binary);
  file << "G0\n";  // as fast as the settings allow: an ideal machine is never behind its answers
  for (long line = 0; line < lines; ++line) {
    char text[32];
    const long x = 1001 + line % 80 + line / 80 % 80 * 100;
    const long y = 101 + line % 9 + line / 80 % 80 * 10;
    std::snprintf(text, sizeof text, "X%ld.%02ldY%ld.%ld", x / 100, x % 10 == 0 ? x % 100 + 1 : x % 100, y / 10,
                  y % 10);
    file << text << comment << '\n';
  }
}

CommandFor kerf_with(const Options& options, const std::string& job, std::optional<int> baud) {
  return [=](const WireEnd& end) {
    const std::string query = "?baud=" + std::to_string(baud.value_or(0));
    const std::string machine = end.kind == WireKind::Tcp ? "tcp://127.0.0.1:" + std::to_string(end.port)
                                : baud                    ? "serial://" + end.path + query
                                                          : "pty://" + end.path;
    return std::vector<std::string>{options.kerf, "run", job, "--machine", machine};
  };
}

CommandFor floor_with(const Options& options, const std::string& job, std::size_t window) {
  return [=](const WireEnd& end) {
    std::vector<std::string> words{options.floor, job, std::to_string(window)};
    if (end.kind == WireKind::Pty) {
      words.push_back(end.path);
    } else {
      words.insert(words.end(), {"127.0.0.1", std::to_string(end.port)});
    }
    return words;
  };
}

void just_wait(IdealController&, ChildProcess&) {
  std::this_thread::sleep_for(milliseconds{20});
}

/// Figures of one program over the rounds.
struct Series {
  std::vector<double> lines_per_s;
  std::vector<double> utilisation;
  std::vector<double> cpu_s;
  std::size_t most_in_flight = 0;
  double peak_mb = 0;

  void add(const StreamRun& run) {
    lines_per_s.push_back(run.account.lines_per_s());
    utilisation.push_back(run.account.utilisation());
    cpu_s.push_back(run.took.cpu_s);
    most_in_flight = std::max(most_in_flight, run.account.most_in_flight);
    peak_mb = std::max(peak_mb, run.memory.peak_mb);
  }
};

/// Floor and Kerf take turns within a round, so that a busy machine disturbs them alike. False if one of them failed.
bool compare(const Options& options, const char* name, WireKind kind, std::optional<int> baud, const std::string& job) {
  const IdealOptions ideal{.rx_bytes = kWindow + 1, .baud = baud};
  Series floor;
  Series kerf;
  std::vector<double> ratios;
  for (int round = 0; round < options.rounds; ++round) {
    const auto least = run_stream(kind, ideal, floor_with(options, job, kWindow), just_wait);
    const auto ours = run_stream(kind, ideal, kerf_with(options, job, baud), just_wait);
    if (!least || !ours) {
      std::printf("%-22s %s did not reach its end\n", name, least ? "kerf run" : "the floor");
      return false;
    }
    floor.add(*least);
    kerf.add(*ours);
    ratios.push_back(ours->account.lines_per_s() / least->account.lines_per_s());
  }
  const auto print = [name, &options](const char* program, const Series& series, bool paced) {
    const Middle rate = middle_of(series.lines_per_s);
    std::printf(
        "%-22s %-6s %9.0f (%.0f to %.0f) lines/s  %s%5.1f %%  cpu %.2f s per 100 k lines  peak %5.1f MB  in flight "
        "%zu\n",
        name, program, rate.median, rate.least, rate.most, paced ? "wire " : "",
        paced ? 100 * middle_of(series.utilisation).median : 0.0,
        middle_of(series.cpu_s).median * 1e5 / static_cast<double>(options.lines), series.peak_mb,
        series.most_in_flight);
  };
  print(kFloor, floor, baud.has_value());
  print(kKerf, kerf, baud.has_value());
  const Middle ratio = middle_of(ratios);
  std::printf("%-22s ratio  %.2f (%.2f to %.2f), cpu %.1f times the floor's\n", name, ratio.median, ratio.least,
              ratio.most, middle_of(kerf.cpu_s).median / middle_of(floor.cpu_s).median);
  return true;
}

bool measure_speed(const Options& options, const std::string& folder) {
  const std::string job = folder + "/speed.nc";
  write_job(job, options.lines, "");
  return compare(options, "pty", WireKind::Pty, std::nullopt, job) &&
         compare(options, "tcp", WireKind::Tcp, std::nullopt, job);
}

bool measure_wire(const Options& options, const std::string& folder) {
  // Five seconds of wire.
  Options paced = options;
  paced.lines = 5L * kBaud / 10 / 12;
  const std::string job = folder + "/wire.nc";
  write_job(job, paced.lines, "");
  return compare(paced, "pty at 115200 baud", WireKind::Pty, kBaud, job) &&
         compare(paced, "tcp at 115200 baud", WireKind::Tcp, kBaud, job);
}

/// Interrupts the program again and again while it streams; each time somebody lets the machine go on.
class HoldTries {
 public:
  /// `watches`: the program asks for reports, and must have seen each hold and its end.
  HoldTries(int tries, bool watches) : tries_(tries), watches_(watches) {}

  void operator()(IdealController& controller, ChildProcess& process) {
    std::this_thread::sleep_for(milliseconds{5});
    if (controller.lines_so_far() == 0) return;
    if (done() && !is_waiting_) return finish(controller, process);
    if (is_waiting_) return follow(controller);
    if ((watches_ && !controller.told_idle()) || ++quiet_ < kQuietTurns + static_cast<int>(to_port_ms.size() % 7))
      return;
    quiet_ = 0;
    is_waiting_ = true;
    before_ns_ = controller.hold_read_ns();
    asked_ns_ = steady_now_ns();
    process.signal(SIGINT);
  }

  std::vector<double> to_port_ms;
  std::vector<double> to_controller_ms;

 private:
  /// So long after a hold Kerf must have seen that the machine goes on; then another may be asked for.
  static constexpr int kQuietTurns = 30;

  [[nodiscard]] bool done() const { return static_cast<int>(to_port_ms.size()) >= tries_; }

  void follow(IdealController& controller) {
    if (controller.hold_read_ns() == before_ns_ || (watches_ && !controller.told_hold())) return;
    to_port_ms.push_back(static_cast<double>(controller.hold_read_ns() - asked_ns_) * 1e-6);
    to_controller_ms.push_back(static_cast<double>(controller.hold_arrived_ns() - asked_ns_) * 1e-6);
    is_waiting_ = false;
    controller.release();
  }

  /// Twice interrupted, the job is stopped.
  static void finish(IdealController&, ChildProcess& process) {
    process.signal(SIGTERM);
    std::this_thread::sleep_for(milliseconds{500});
  }

  int tries_;
  bool watches_;
  int quiet_ = 0;
  bool is_waiting_ = false;
  std::int64_t before_ns_ = 0;
  std::int64_t asked_ns_ = 0;
};

double percentile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

bool hold(const Options& options, const char* name, WireKind kind, const IdealOptions& ideal, const char* program,
          const CommandFor& command) {
  HoldTries tries(options.tries, program == kKerf);
  // The job is stopped in the end, so the program does not end well.
  static_cast<void>(run_stream(kind, ideal, command, std::ref(tries)));
  if (tries.to_port_ms.empty()) {
    std::printf("%-34s %-5s no hold arrived\n", name, program);
    return false;
  }
  std::printf("%-34s %-5s %zu holds, median / p99 / worst: to the port %.3f / %.3f / %.3f ms", name, program,
              tries.to_port_ms.size(), percentile(tries.to_port_ms, 0.5), percentile(tries.to_port_ms, 0.99),
              percentile(tries.to_port_ms, 1));
  if (ideal.baud) {
    std::printf(", to the controller %.1f / %.1f / %.1f ms", percentile(tries.to_controller_ms, 0.5),
                percentile(tries.to_controller_ms, 0.99), percentile(tries.to_controller_ms, 1));
  }
  std::printf("\n");
  return true;
}

bool hold_beside_floor(const Options& options, const char* name, WireKind kind, const IdealOptions& ideal,
                       const std::string& job) {
  return hold(options, name, kind, ideal, kFloor, floor_with(options, job, ideal.rx_bytes - 1)) &&
         hold(options, name, kind, ideal, kKerf, kerf_with(options, job, ideal.baud));
}

bool measure_hold(const Options& options, const std::string& folder) {
  const std::string job = folder + "/hold.nc";
  // Nobody comes to its end.
  constexpr long kEndless = 40'000'000;
  write_job(job, kEndless, "");
  return hold_beside_floor(options, "pty, streaming flat out", WireKind::Pty, {.rx_bytes = kWindow + 1}, job) &&
         hold_beside_floor(options, "tcp, streaming flat out", WireKind::Tcp, {.rx_bytes = kWindow + 1}, job) &&
         hold_beside_floor(options, "115200 baud, buffer of 128 bytes", WireKind::Pty, {.rx_bytes = 128, .baud = kBaud},
                           job) &&
         hold_beside_floor(options, "115200 baud, buffer of 1024 bytes", WireKind::Pty,
                           {.rx_bytes = 1024, .baud = kBaud}, job);
}

/// The most that `kerf run` ever has of its own, and with the pages of files.
bool memory_of(const Options& options, double megabytes, const std::string& folder) {
  // With comments, so that a gigabyte is streamed in minutes.
  const std::string comment = " (" + std::string(85, '-') + ")";
  const std::size_t line_bytes = 12 + comment.size();
  const std::string job = folder + "/memory.nc";
  write_job(job, static_cast<long>(megabytes * kBytesAMegabyte / static_cast<double>(line_bytes)), comment);
  double own_mb = 0;
  std::int64_t started_ns = steady_now_ns();
  std::int64_t first_line_ns = 0;
  const auto run = run_stream(WireKind::Tcp, {.rx_bytes = 1024}, kerf_with(options, job, std::nullopt),
                              [&](IdealController& controller, ChildProcess& process) {
                                if (const auto memory = process.memory()) own_mb = std::max(own_mb, memory->own_mb);
                                if (first_line_ns == 0 && controller.lines_so_far() > 0)
                                  first_line_ns = steady_now_ns();
                                just_wait(controller, process);
                              });
  std::filesystem::remove(job);
  if (!run) {
    std::printf("%.0f MB: kerf run did not reach its end\n", megabytes);
    return false;
  }
  std::printf(
      "%6.0f MB, %9llu lines: first line after %5.1f s, then %6.0f lines/s; peak %5.1f MB, of it own %5.1f MB\n",
      megabytes, static_cast<unsigned long long>(run->account.job_lines),
      static_cast<double>(first_line_ns - started_ns) * 1e-9, run->account.lines_per_s(), run->memory.peak_mb, own_mb);
  return true;
}

bool measure_memory(const Options& options, const std::string& folder) {
  return memory_of(options, 1, folder) && memory_of(options, 10, folder) &&
         memory_of(options, static_cast<double>(options.megabytes), folder);
}

std::optional<Options> parse_options(int argc, char** argv) {
  Options options;
  for (int at = 1; at + 1 < argc; at += 2) {
    const std::string_view name = argv[at];
    const char* const value = argv[at + 1];
    if (name == "--kerf") options.kerf = value;
    if (name == "--floor") options.floor = value;
    if (name == "--only") options.what = value;
    if (name == "--rounds") options.rounds = std::atoi(value);
    if (name == "--lines") options.lines = std::atol(value);
    if (name == "--tries") options.tries = std::atoi(value);
    if (name == "--megabytes") options.megabytes = std::atol(value);
  }
  if (options.kerf.empty() || options.floor.empty() || options.rounds < 1 || argc % 2 == 0) return std::nullopt;
  return options;
}

int run(const Options& options) {
  const ScratchFolder scratch;
  // Journal, recordings and kept settings of this run only.
  setenv("XDG_STATE_HOME", scratch.path().c_str(), 1);
  const auto wanted = [&](std::string_view what) { return options.what == "all" || options.what == what; };
  bool is_good = true;
  if (wanted("speed")) is_good = measure_speed(options, scratch.path()) && is_good;
  if (wanted("wire")) is_good = measure_wire(options, scratch.path()) && is_good;
  if (wanted("hold")) is_good = measure_hold(options, scratch.path()) && is_good;
  if (wanted("memory")) is_good = measure_memory(options, scratch.path()) && is_good;
  return is_good ? 0 : 1;
}

}  // namespace
}  // namespace kerf::bench

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const auto options = kerf::bench::parse_options(argc, argv);
  if (!options) {
    std::fputs(
        "usage: stream --kerf PROGRAM --floor LEAST_COUNTER [--only speed|wire|hold|memory] [--rounds N] [--lines N]\n"
        "              [--tries N] [--megabytes N]\n",
        stderr);
    return 1;
  }
  return kerf::bench::run(*options);
}
