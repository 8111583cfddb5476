// How long three simulated hours take: prints seconds for each firmware. Usage: three_hour_job [HOURS]

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "common/vocabulary/dialect.hpp"
#include "simulation/long_job.hpp"
#include "simulation/world.hpp"

int main(int argc, char** argv) {
  using namespace kerf::simulation;
  const int hours = argc > 1 ? std::atoi(argv[1]) : 3;
  int failures = 0;
  for (const auto* const dialect : kerf::vocabulary::all_dialects()) {
    auto options = serial_world(dialect->firmware, 115200);
    options.stored.initialised = true;
    for (const char* const rate : {"110", "111", "112"}) options.stored.settings[rate] = "5000.000";
    for (const char* const acceleration : {"120", "121", "122"}) options.stored.settings[acceleration] = "500.000";
    const auto part = *kerf::job::Program::load("long_job.nc", long_job(hours));
    const auto started_at = std::chrono::steady_clock::now();
    World world{options};
    const auto job = run_job(world, part, std::chrono::hours{hours * 2});
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started_at;
    const bool finished = job && job->phase == kerf::job::JobPhase::Finished;
    if (!finished) ++failures;
    std::printf("%-8.*s %s: %.0f s simulated in %.2f s, %zu transcript entries\n",
                static_cast<int>(dialect->key.size()), dialect->key.data(), finished ? "finished" : "NOT finished",
                job ? job->progress.elapsed_s : 0.0, took.count(), world.transcript().size());
  }
  return failures;
}
