#include "apps/rehearsal.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "common/vocabulary/dialect.hpp"
#include "sender/job/wire_form.hpp"
#include "simulation/machine_like.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::apps {
namespace {

/// Some 50,000 lines, which take less than a second; twenty times that on a small computer.
constexpr std::size_t kMostBytes = 1'000'000;

/// One line a file line, so that the rehearsal counts them as the file does.
std::string as_sent(const job::Program& program, job::WireForm form) {
  std::string text;
  for (auto line = program.line_at(0, 1); line; line = program.line_at(program.offset_after(*line), line->number + 1)) {
    job::append_wire_form(text, line->text, form);
    text += '\n';
  }
  return text;
}

}  // namespace

std::shared_ptr<const job::Timeline> rehearse(const job::Program& program, const machine::Capabilities& capabilities,
                                              double speed) {
  if (capabilities.family == vocabulary::Firmware::Unknown || program.size_bytes() > kMostBytes) return nullptr;
  const auto form = job::wire_form_of(vocabulary::dialect_of(capabilities.family));
  const auto trace =
      simulation::trace_program({.program = as_sent(program, form)}, simulation::machine_like(capabilities));
  const bool ran_through = trace.errors.empty() && trace.alarms.empty() && trace.lines_answered == trace.lines;
  if (!ran_through || trace.blocks.empty()) return nullptr;

  auto timeline = std::make_shared<job::Timeline>();
  timeline->speed = speed;
  timeline->lines_ahead_at_most = static_cast<std::uint32_t>(std::max(capabilities.buffers.planner_blocks, 1));
  timeline->end_s.assign(program.line_count(), 0.0);
  for (const auto& block : trace.blocks) {
    if (block.line > 0 && block.line <= timeline->end_s.size()) timeline->end_s[block.line - 1] = block.end_s;
  }
  timeline->end_s.back() = trace.total_s;
  double latest_s = 0;
  for (double& end_s : timeline->end_s) end_s = latest_s = std::max(latest_s, end_s);
  return timeline;
}

}  // namespace kerf::apps
