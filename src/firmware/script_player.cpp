#include "firmware/script_player.hpp"

#include <algorithm>
#include <utility>

#include "common/base/overloaded.hpp"

namespace kerf::firmware {

Instant ScriptPlayer::due_at(const Waiting& next, Instant first_power_on) const {
  const auto* const at = std::get_if<AtTime>(&next.line.timing);
  if (at != nullptr) return first_power_on + at->time;
  const auto* const after = std::get_if<AfterTime>(&next.line.timing);
  if (after != nullptr) return std::max(last_done_, next.added_at) + after->time;
  return kNever;
}

std::optional<ScriptLine> ScriptPlayer::take_due(const View& view) {
  if (waiting_.empty()) return std::nullopt;
  const Waiting& next = waiting_.front();
  const bool is_due =
      std::visit(base::Overloaded{
                     [&](const WhenState& when) {
                       return view.state == when.state && (!when.substate || view.substate == when.substate);
                     },
                     [&](const WhenLine& when) { return view.lines_begun >= when.lines; },
                     [&](const auto&) { return view.now >= due_at(next, view.first_power_on); },
                 },
                 next.line.timing);
  if (!is_due) return std::nullopt;
  ScriptLine line = std::move(waiting_.front().line);
  waiting_.pop_front();
  last_done_ = view.now;
  return line;
}

Instant ScriptPlayer::next_deadline(Instant first_power_on) const {
  return waiting_.empty() ? kNever : due_at(waiting_.front(), first_power_on);
}

bool ScriptPlayer::waits_for_machine() const {
  return !waiting_.empty() && (std::holds_alternative<WhenState>(waiting_.front().line.timing) ||
                               std::holds_alternative<WhenLine>(waiting_.front().line.timing));
}

}  // namespace kerf::firmware
