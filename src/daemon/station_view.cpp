// A machine as clients see it.

#include <utility>
#include <variant>

#include "daemon/station.hpp"
#include "sender/machine/explanation_evidence.hpp"
#include "sender/session/refusals.hpp"

namespace kerf::daemon {
namespace {

using machine::Capabilities;
using machine::setting_number;

// Numbers of settings that all three firmwares have.
constexpr int kSoftLimits = 20;
constexpr int kHoming = 22;
constexpr int kMaxRpm = 30;
constexpr int kMinRpm = 31;
constexpr int kMode = 32;
constexpr int kMaxRates = 110;
constexpr int kAccelerations = 120;

std::optional<std::vector<double>> by_axis(const Capabilities& known, int first) {
  std::vector<double> values;
  for (std::size_t axis = 0; axis < known.axes.letters.size(); ++axis) {
    const auto value = setting_number(known, first + static_cast<int>(axis));
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

TroubleView trouble_of(const machine::Explanation& explanation) {
  return {.kind = boost::describe::enum_to_string(explanation.kind, "?"),
          .headline = explanation.headline,
          .evidence = explanation.evidence,
          .steps = explanation.next_steps};
}

std::string sentence_of(const std::optional<session::Refused>& why) {
  return why ? session::sentence_of(*why) : std::string{};
}

}  // namespace

LimitsView Station::limits_of(const Capabilities& known) const {
  LimitsView limits{.axes = known.axes.letters,
                    .max_feed_mm_per_min = by_axis(known, kMaxRates),
                    .acceleration_mm_per_s2 = by_axis(known, kAccelerations),
                    .homing_enabled = known.features.homing.enabled,
                    .soft_limits = known.features.soft_limits.available,
                    .spindle_max_rpm = setting_number(known, kMaxRpm),
                    .spindle_min_rpm = setting_number(known, kMinRpm)};
  if (const auto mode = setting_number(known, kMode)) limits.laser_mode = *mode == 1;
  const auto& dialect = vocabulary::dialect_of(known.family);
  std::vector<double> least;
  std::vector<double> most;
  for (std::size_t axis = 0; axis < known.axes.letters.size(); ++axis) {
    const auto travel = machine::travel_of_axis(axis, known, dialect);
    if (!travel) return limits;
    // Adding 0 makes 0 of -0.
    least.push_back(travel->min_mm + 0.0);
    most.push_back(travel->max_mm + 0.0);
  }
  limits.min_mm = std::move(least);
  limits.max_mm = std::move(most);
  return limits;
}

LinkView Station::link_view() const {
  LinkView link{.phase = phase_, .sentence = phase_sentence_, .since_s = base::to_seconds(phase_since_)};
  if (!host_) return link;
  const session::LinkHealth health = host_->session().link_health(services_.loop->now());
  link.silent_for_s = health.silent_for_s;
  link.round_trip_s = health.answer_time_s;
  return link;
}

CanView Station::can_view() const {
  const std::string no_link = "The machine is not connected.";
  CanView can{.start = no_link,
              .hold = no_link,
              .resume = no_link,
              .stop = no_link,
              .abort = no_link,
              .jog = no_link,
              .home = no_link,
              .unlock = no_link,
              .send_line = no_link,
              .change_settings = no_link,
              .overrides = no_link};
  if (!host_ || !host_->is_open()) return can;
  // These are never refused while there is a link: what is pressed in an emergency has to go out.
  can.hold = can.stop = can.abort = "";
  if (!is_ready()) return can;
  const Instant now = services_.loop->now();
  const session::Session& session = host_->session();
  const std::string preparing = starter_.is_busy() ? "A job is about to begin." : "";
  const auto line = [&](std::string_view text) {
    return preparing.empty() ? sentence_of(session.why_no_line(now, text)) : preparing;
  };
  can.start = !preparing.empty() ? preparing
              : !program_        ? "No program is loaded."
                                 : sentence_of(session.why_no_job(now));
  can.resume = session.can_resume() ? "" : session::sentence_of(session::Refused::NotAtRest);
  can.jog = line("$J=G91X1F1");
  using vocabulary::MachineState;
  const MachineState state = session.snapshot().state;
  // The session sends a jog in every state, and the controller says what is wrong with it.
  if (can.jog.empty() && state == MachineState::Alarm) can.jog = session::sentence_of(session::Refused::MachineInAlarm);
  if (can.jog.empty() && state == MachineState::Door) can.jog = "The safety door is open: close it first.";
  can.home = line("$H");
  if (can.home.empty() && limits_.homing_enabled == false)
    can.home = "Homing is switched off in the machine's settings.";
  can.unlock = line("$X");
  if (can.unlock.empty() && session.snapshot().state != vocabulary::MachineState::Alarm) {
    can.unlock = "The machine is not locked.";
  }
  can.send_line = line("G4P0");
  can.change_settings = line("$$");
  can.overrides = "";
  return can;
}

std::optional<TroubleView> Station::trouble_view() const {
  if (!host_) return std::nullopt;
  const session::Session& session = host_->session();
  if (const auto alarm = session.alarm_explanation()) return trouble_of(*alarm);
  const auto& job = session.job();
  // A long move and a dwell are no trouble; what the state tells anyway is not told twice.
  const bool is_stuck = job && job->stall && !job::is_final(job->phase) &&
                        (job::needs_decision(job->stall->cause) || job->stall->cause == job::StallCause::NotReading);
  if (is_stuck) {
    return TroubleView{.kind = "Stall",
                       .headline = job->stall->headline,
                       .evidence = job->stall->evidence,
                       .steps = job->stall->steps};
  }
  if (job && job->departure && !job::is_final(job->phase)) {
    return TroubleView{.kind = "OffPath",
                       .headline = job::describe(*job->departure),
                       .evidence = {},
                       .steps = {"Stop the job.", "Home the machine and check the work zero before going on."}};
  }
  if (last_refusal_) return trouble_of(*last_refusal_);
  return std::nullopt;
}

MachineView Station::view() const {
  MachineView view{.name = row_.name,
                   .url = row_.url,
                   .is_virtual = std::holds_alternative<io::VirtualAddress>(url_),
                   .link = link_view(),
                   .busy = busy_,
                   .limits = limits_,
                   .preparation = starter_.view(),
                   .trouble = trouble_view(),
                   .notes = notes_.all(),
                   .can = can_view()};
  if (program_) view.program = program_->id;
  if (jog_.is_held()) view.jog = JogView{.lease = jog_client_};
  for (const auto& row : interrupted_) {
    view.interrupted.push_back({.job = row.number,
                                .program = row.program,
                                .ended = row.stopped,
                                .line = row.line_acknowledged,
                                .lines = row.lines,
                                .reason = row.why});
  }
  if (!host_) return view;
  const session::Session& session = host_->session();
  view.snapshot = session.snapshot();
  const Capabilities& known = session.capabilities();
  view.firmware = {.name = known.firmware, .version = known.version, .build = known.build};
  if (session.job()) {
    view.job.emplace();
    static_cast<job::JobState&>(*view.job) = *session.job();
    view.job->program_id = job_program_;
  }
  return view;
}

}  // namespace kerf::daemon
