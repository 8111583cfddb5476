#include "simulation/conformance.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <variant>

#include "firmware/personality.hpp"
#include "simulation/dice.hpp"
#include "simulation/motion_trace.hpp"
#include "simulation/varied_job.hpp"
#include "simulation/world.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using vocabulary::Firmware;

constexpr double kOffMm = 0.05;
constexpr std::size_t kAxes = 3;
/// Of the machine that gets damaged jobs.
constexpr double kSteps = 250.0;

firmware::StoredState machine_of(Dice& dice, Firmware firmware) {
  firmware::StoredState stored;
  stored.initialised = true;
  const int steps = dice.pick({80, 160, 250, 400});
  for (const std::string axis : {"0", "1", "2"}) {
    stored.settings["10" + axis] = std::to_string(steps) + ".000";
    stored.settings["11" + axis] = dice.pick<std::string>({"1500.000", "3000.000", "5000.000"});
    stored.settings["12" + axis] = dice.pick<std::string>({"50.000", "300.000", "800.000"});
  }
  const bool tells_machine_position = !dice.one_in(3);
  const unsigned rest = firmware == Firmware::GrblHal ? 510U : 2U * static_cast<unsigned>(dice.below(2));
  stored.settings["10"] = std::to_string(rest | (tells_machine_position ? 1U : 0U));
  stored.settings["13"] = dice.one_in(4) ? "1" : "0";
  if (firmware == Firmware::GrblHal && dice.one_in(4)) stored.settings["481"] = "100";
  return stored;
}

WorldOptions world_of(Dice& dice, Firmware firmware, bool keeps_conversation) {
  auto options = dice.one_in(2) ? serial_world(firmware, 115200) : network_world(firmware, 15ms);
  options.stored = machine_of(dice, firmware);
  options.keeps_transcript = keeps_conversation;
  options.keeps_wire_log = false;
  return options;
}

bool is_ready(const World& world) {
  return world.session().phase() == session::SessionPhase::Ready;
}

bool is_over(const World& world) {
  return world.session().job() && job::is_final(world.session().job()->phase);
}

bool is_quiet(const World& world) {
  const auto& now = world.session().snapshot();
  return now.state == vocabulary::MachineState::Idle && world.session().ledger().empty() && !now.parser_state_is_old &&
         !now.offsets_are_old && !world.controller().is_moving();
}

/// What an operator does before he starts a job: jogs about, sets a zero.
void prepare(World& world, Dice& dice) {
  world.run_until(is_quiet, 20s);
  const int jogs = dice.between(0, 3);
  for (int i = 0; i < jogs; ++i) {
    world.submit(session::Jog{"G91G21X" + std::to_string(dice.between(-20, 20)) + "Y" +
                              std::to_string(dice.between(-20, 20)) + "Z" + std::to_string(dice.between(0, 2)) +
                              "F900"});
    world.run_for(100ms);
    world.run_until(is_quiet, 20s);
  }
  if (dice.one_in(2)) world.submit(session::SendLine{"G10L20P1X0Y0Z0"});
  world.run_for(100ms);
  world.run_until(is_quiet, 20s);
  const auto& offset = world.session().snapshot().work_offset_mm;
  if (offset) world.touch(firmware::ProbeSurfaceMoved{.z_mm = offset->at(2) - 2.0});
}

void disturb(World& world, Dice& dice) {
  const auto byte = [&](std::uint8_t code) { world.submit(session::SendRealtime{code}); };
  switch (dice.below(12)) {
    case 0:
    case 1:
      world.submit(session::HoldJob{});
      world.run_for(100ms + dice.up_to(3s));
      return;
    case 2: byte(0x91); return;
    case 3: byte(0x92); return;
    case 4: byte(0x90); return;
    case 5: byte(dice.pick<std::uint8_t>({0x95, 0x96, 0x97})); return;
    case 6: byte(dice.pick<std::uint8_t>({0x99, 0x9A, 0x9B})); return;
    case 7:
      static_cast<void>(world.order("door open"));
      world.run_for(dice.up_to(6s));
      static_cast<void>(world.order("door close"));
      world.run_for(500ms);
      return;
    case 8: byte(0xA0); return;
    default: return;
  }
}

std::string summary(const job::JobState& job) {
  const std::string where = " (line " + std::to_string(job.progress.file_line) + ")";
  return job.departure ? describe(*job.departure) + where : job.reason + where;
}

}  // namespace

CleanRun clean_run(Firmware firmware, std::uint64_t seed, bool keeps_conversation) {
  Dice dice{seed};
  World world{world_of(dice, firmware, keeps_conversation)};
  world.open();
  CleanRun run;
  if (!world.run_until(is_ready, 60s)) {
    run.unfinished = "the machine was not found";
    return run;
  }
  prepare(world, dice);
  const VariedJobParts parts{.pauses = dice.one_in(2), .probing = dice.one_in(3)};
  const auto program = job::Program::load("varied.nc", varied_job(dice, firmware, parts, 40));
  world.submit(session::StartJob{*program});
  const Instant began = world.now();
  const auto reports_before = world.session().snapshot().reports;
  run.lines = (*program)->line_count();
  run.program = (*program)->text();
  while (!is_over(world) && world.now() - began < 6h) {
    world.run_for(dice.up_to(8s));
    const auto& job = world.session().job();
    if (!job) break;
    if (job->departure) {
      run.false_alarm = summary(*job);
      break;
    }
    if (job->phase == job::JobPhase::Held) world.submit(session::ResumeJob{});
    if (job->phase == job::JobPhase::Running) disturb(world, dice);
  }
  run.hours = base::to_seconds(world.now() - began) / 3600.0;
  run.conversation = world.transcript_text();
  run.reports = static_cast<std::size_t>(world.session().snapshot().reports - reports_before);
  for (const auto& event : world.events()) {
    if (const auto* gap = std::get_if<session::PathUnwatched>(&event)) run.gap = gap->sentence;
  }
  const auto& job = world.session().job();
  if (!run.false_alarm && (!job || job->phase != job::JobPhase::Finished)) {
    run.unfinished =
        job ? summary(*job) + std::string{boost::describe::enum_to_string(job->phase, "")} : "no job began";
    if (job && job->refusal) *run.unfinished += ": " + job->refusal->text;
  }
  return run;
}

namespace {

using Point = std::array<double, kAxes>;

Point point_of(const vocabulary::AxisSteps& steps, double steps_per_mm) {
  Point point{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) point.at(axis) = steps.at(axis) / steps_per_mm;
  return point;
}

double distance(const Point& from, const Point& to, const Point& at) {
  double way_way = 0;
  double way_off = 0;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const double way = to.at(axis) - from.at(axis);
    way_way += way * way;
    way_off += way * (at.at(axis) - from.at(axis));
  }
  const double part = way_way > 0 ? std::clamp(way_off / way_way, 0.0, 1.0) : 0.0;
  double square = 0;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const double off = at.at(axis) - std::lerp(from.at(axis), to.at(axis), part);
    square += off * off;
  }
  return std::sqrt(square);
}

/// The path of the undamaged program, as the same machine cut it, and how far along it the machine has come.
class TruePath {
 public:
  TruePath(const std::string& program, Firmware firmware, const firmware::StoredState& stored, double steps_per_mm) {
    const CaseMachine machine{.personality = firmware::personality_of(firmware), .stored = stored};
    const auto trace = trace_program({.program = program}, machine);
    ends_.push_back({});
    for (const auto& block : trace.blocks) ends_.push_back(point_of(block.end_steps, steps_per_mm));
    ends_.push_back(ends_.back());
  }

  /// Distance of a place from what is left of the path.
  double off(const Point& at) {
    constexpr std::size_t kFarAhead = 300;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](std::size_t to) {
      for (std::size_t i = reached_; i + 1 < std::min(to, ends_.size()); ++i) {
        const double here = distance(ends_[i], ends_[i + 1], at);
        if (here < kOffMm / 2) {
          reached_ = i;
          return here;
        }
        least = std::min(least, here);
      }
      return least;
    };
    const double near = look(reached_ + kFarAhead);
    return near <= kOffMm ? near : look(ends_.size());
  }

 private:
  std::vector<Point> ends_;
  std::size_t reached_ = 0;
};

/// When the machine left its path, as nobody but the simulation knows it.
class Excursion {
 public:
  explicit Excursion(const TruePath& path) : machine_{path}, told_{path} {}

  void look(const World& world) {
    const auto& snapshot = world.session().snapshot();
    const Instant now = world.now();
    const bool is_off = machine_.off(point_of(world.controller().position_steps(), kSteps)) > kOffMm;
    if (is_off && !since_) since_ = now;
    if (is_off) back_.reset();
    if (since_ && !is_off && !back_) back_ = now;
    if (since_ && now <= *since_ + kOnTheWay) reports_then_ = snapshot.reports;
    if (snapshot.reports != reports_ && snapshot.machine_position_mm) {
      reports_ = snapshot.reports;
      Point at{};
      std::ranges::copy_n(snapshot.machine_position_mm->begin(), kAxes, at.begin());
      is_told_ = is_told_ || (since_ && told_.off(at) > kOffMm);
    }
    if (!is_told_ && back_ && now > *back_ + kOnTheWay) {
      ++untold_;
      since_.reset();
      back_.reset();
    }
  }

  [[nodiscard]] std::optional<Instant> since() const { return since_; }
  /// Reports that were made since then.
  [[nodiscard]] int reports(const World& world) const {
    return static_cast<int>(world.session().snapshot().reports - reports_then_);
  }
  /// How often it was back before a report told of it.
  [[nodiscard]] int untold() const { return untold_; }

 private:
  static constexpr Duration kOnTheWay = 20ms;
  TruePath machine_;
  TruePath told_;
  std::optional<Instant> since_;
  std::optional<Instant> back_;
  std::uint64_t reports_then_ = 0;
  std::uint64_t reports_ = 0;
  bool is_told_ = false;
  int untold_ = 0;
};

}  // namespace

DamagedRun damaged_run(Firmware firmware, std::uint64_t seed, bool keeps_conversation) {
  Dice dice{seed};
  auto options = serial_world(firmware, 115200);
  firmware::StoredState stored;
  stored.initialised = true;
  for (const std::string axis : {"0", "1", "2"}) {
    stored.settings["10" + axis] = "250.000";
    stored.settings["11" + axis] = "3000.000";
    stored.settings["12" + axis] = "300.000";
  }
  options.stored = stored;
  options.keeps_transcript = keeps_conversation;
  options.keeps_wire_log = false;
  DamagedRun run;
  const std::string text = varied_job(dice, firmware, {.pauses = false, .probing = false}, 12);
  run.program = text;
  Excursion excursion{TruePath{text, firmware, stored, kSteps}};
  World world{options};
  world.open();
  if (!world.run_until(is_ready, 60s)) return run;
  world.run_until(is_quiet, 20s);
  world.submit(session::StartJob{*job::Program::load("part.nc", text)});
  world.run_for(dice.up_to(40s));
  // A byte of a line, not one of the many questions.
  const auto sent = world.session().ledger().lines_entered();
  world.run_until([&](const World& at) { return at.session().ledger().lines_entered() > sent; }, 30s);
  world.run_for(dice.up_to(1500us));
  static_cast<void>(
      world.order(dice.pick<std::string>({"corrupt to next 1", "drop to next 1", "duplicate to next 1"})));
  const auto job_said = [&] { return world.session().job() && world.session().job()->departure; };
  const Instant end = world.now() + 2h;
  while (!is_over(world) && world.now() < end && world.step(end)) {
    if (job_said()) break;
    const auto& job = world.session().job();
    if (job->phase == job::JobPhase::Draining || job->refusal || job->alarm_code) {
      if (!excursion.since()) run.end = DamagedRunEnd::Refused;
      break;
    }
    if (job->phase == job::JobPhase::Held) break;
    excursion.look(world);
    if (excursion.since() && world.now() - *excursion.since() > 10s) break;
    if (world.session().link_health(world.now()).silent_for_s.value_or(0) > 20) break;
  }
  run.conversation = world.transcript_text();
  for (const auto& record : world.log()) {
    if (record.kind == firmware::RigRecordKind::Fault) run.damage += record.what + "; ";
  }
  if (job_said()) run.said = describe(*world.session().job()->departure);
  if (excursion.since()) {
    run.noticed_after = world.now() - *excursion.since();
    run.reports = excursion.reports(world);
    run.end = job_said() && run.reports <= 1 ? DamagedRunEnd::Held : DamagedRunEnd::Missed;
  } else if (job_said()) {
    run.end = DamagedRunEnd::Held;
  } else if (world.session().job() && world.session().job()->phase != job::JobPhase::Finished) {
    run.end = DamagedRunEnd::Refused;
  } else if (excursion.untold() > 0) {
    run.end = DamagedRunEnd::Untold;
  }
  return run;
}

}  // namespace kerf::simulation
