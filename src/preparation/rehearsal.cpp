#include "preparation/rehearsal.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/vocabulary/dialect.hpp"
#include "rehearsal/sent_lines.hpp"
#include "simulation/machine_like.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::preparation {
namespace {

/// Some 50,000 lines, which take less than a second; twenty times that on a small computer.
constexpr std::size_t kMostBytes = 1'000'000;

}  // namespace

std::shared_ptr<const job::Timeline> rehearse(const job::Program& program, const machine::Capabilities& capabilities,
                                              double speed) {
  if (capabilities.family == vocabulary::Firmware::Unknown || program.size_bytes() > kMostBytes) return nullptr;
  const auto machine = simulation::machine_like(capabilities);
  const simulation::ProgramRun run{.program = {}, .operator_goes_on = true};
  simulation::ProgramTracer tracer(
      run, machine,
      std::make_unique<rehearsal::SentText>(rehearsal::SentLines(program, machine.personality.dialect())));
  auto timeline = std::make_shared<job::Timeline>();
  timeline->speed = speed;
  timeline->lines_ahead_at_most = static_cast<std::uint32_t>(std::max(capabilities.buffers.planner_blocks, 1));
  timeline->end_s.assign(program.line_count(), 0.0);
  double rapid_s = 0;
  std::vector<simulation::BlockTrace> blocks;
  for (bool goes_on = true; goes_on;) {
    blocks.clear();
    goes_on = tracer.run_on(blocks);
    for (const auto& block : blocks) {
      if (block.line > 0 && block.line <= timeline->end_s.size()) timeline->end_s[block.line - 1] = block.end_s;
      if (block.rapid) rapid_s += block.end_s - block.start_s;
    }
  }
  const auto trace = tracer.finish();
  const bool ran_through = trace.errors.empty() && trace.alarms.empty() && trace.lines_answered == trace.lines;
  if (!ran_through || trace.block_count == 0) return nullptr;
  timeline->end_s.back() = trace.total_s;
  if (trace.total_s > 0) timeline->rapid_share = std::clamp(rapid_s / trace.total_s, 0.0, 1.0);
  double latest_s = 0;
  for (double& end_s : timeline->end_s) end_s = latest_s = std::max(latest_s, end_s);
  return timeline;
}

}  // namespace kerf::preparation
