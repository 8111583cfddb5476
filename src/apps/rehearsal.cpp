#include "apps/rehearsal.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/vocabulary/dialect.hpp"
#include "firmware/personality.hpp"
#include "sender/job/wire_form.hpp"
#include "simulation/motion_trace.hpp"

namespace kerf::apps {
namespace {

/// Some 50,000 lines, which take less than a second; twenty times that on a small computer.
constexpr std::size_t kMostBytes = 1'000'000;

/// Locks and limits: the rehearsal starts at the machine's zero wherever the real machine stands.
constexpr std::array<std::string_view, 4> kSettingsLeftOut = {"20", "21", "22", "64"};

/// One line a file line, so that the rehearsal counts them as the file does.
std::string as_sent(const job::Program& program, job::WireForm form) {
  std::string text;
  for (auto line = program.line_at(0, 1); line; line = program.line_at(program.offset_after(*line), line->number + 1)) {
    job::append_wire_form(text, line->text, form);
    text += '\n';
  }
  return text;
}

simulation::CaseMachine machine_like(const machine::Capabilities& capabilities) {
  simulation::CaseMachine machine{.personality = firmware::personality_of(capabilities.family)};
  machine.stored.initialised = true;
  for (const auto& setting : capabilities.settings) {
    if (!setting.value || std::ranges::find(kSettingsLeftOut, setting.id) != kSettingsLeftOut.end()) continue;
    machine.stored.settings[setting.id] = *setting.value;
  }
  return machine;
}

}  // namespace

std::shared_ptr<const job::Timeline> rehearse(const job::Program& program, const machine::Capabilities& capabilities,
                                              double speed) {
  if (capabilities.family == vocabulary::Firmware::Unknown || program.size_bytes() > kMostBytes) return nullptr;
  const auto form = job::wire_form_of(vocabulary::dialect_of(capabilities.family));
  const auto trace = simulation::trace_program({.program = as_sent(program, form)}, machine_like(capabilities));
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
