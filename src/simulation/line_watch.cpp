#include "simulation/line_watch.hpp"

#include <algorithm>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"

namespace kerf::simulation {
namespace {

using streaming::Purpose;

bool can_move(Purpose purpose) {
  return purpose == Purpose::JobLine || purpose == Purpose::Operator;
}

bool announces_reset(const session::Event& event) {
  return std::holds_alternative<session::ControllerReset>(event);
}

}  // namespace

void LineWatch::on_command(const session::Command& command) {
  std::visit(base::Overloaded{
                 [&](const session::SoftReset&) { reset_was_asked_for_ = true; },
                 [&](const session::AbortJob&) { reset_was_asked_for_ = true; },
                 [&](const session::StopJob&) { reset_was_asked_for_ = true; },
                 [&](const session::SendRealtime& byte) { reset_was_asked_for_ |= byte.byte == 0x18; },
                 [](const auto&) {},
             },
             command);
}

void LineWatch::look(Instant now, const firmware::Rig& rig, bool has_job) {
  const bool moves = rig.is_powered() && rig.controller().is_moving();
  if (!moves) {
    moving_since_.reset();
    return;
  }
  if (moving_since_) return;
  moving_since_ = now;
  is_own_ = kerf_moves_ && (!stranger_acted_ || has_job);
  if (!is_own_) ++foreign_stretches_;
}

void LineWatch::on_outbox(Instant now, const session::Outbox& out) {
  if (out.realtime.contains('\x18')) on_reset(now, std::ranges::any_of(out.events, announces_reset));
  if (out.realtime.find_first_of("~\x81") != std::string::npos) {
    kerf_moves_ = true;
    stranger_acted_ = false;
  }
  for (const auto& event : out.events) {
    if (const auto* line = std::get_if<session::LineSent>(&event)) on_line(now, *line);
  }
}

bool LineWatch::is_knowably_foreign(Instant now) const {
  return is_in_foreign_motion() && now - *moving_since_ > kNotice;
}

void LineWatch::on_line(Instant now, const session::LineSent& line) {
  if (is_knowably_foreign(now)) complain(now, "the line \"" + line.text + "\" went to a machine in foreign motion");
  if (!can_move(line.purpose)) return;
  kerf_moves_ = true;
  stranger_acted_ = false;
}

void LineWatch::on_reset(Instant now, bool announced) {
  if (!announced && !reset_was_asked_for_) complain(now, "a reset without a word");
  if (announced && is_knowably_foreign(now)) complain(now, "a reset of a machine in foreign motion");
  reset_was_asked_for_ = false;
  kerf_moves_ = false;
}

void LineWatch::complain(Instant now, std::string_view what) {
  broken_.push_back("at " + base::to_fixed(base::to_seconds(now), 3) + " s: " + std::string{what});
}

}  // namespace kerf::simulation
