#include "simulation/campaign.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>

#include "common/base/text.hpp"
#include "sender/job/resume_facts.hpp"
#include "sender/job/resume_plan.hpp"
#include "simulation/cutter_watch.hpp"
#include "simulation/departure_watch.hpp"
#include "simulation/dice.hpp"
#include "simulation/undisturbed_job.hpp"
#include "simulation/world.hpp"

namespace kerf::simulation {
namespace {

using namespace std::chrono_literals;
using job::JobPhase;
using session::SessionPhase;

constexpr Duration kOperatorLooks = 50ms;
constexpr Duration kConnectLimit = 60s;
constexpr Duration kStartLimit = 20s;
/// Homing finds a switch to within a few steps.
constexpr int kSameSteps = 5;
/// With feed overrides at 10 % and an operator who takes his time.
constexpr int kSlowestJob = 15;
constexpr Duration kPatience = 120s;
/// After an interruption the controller may execute what it had, and then rests.
constexpr Duration kAfterwards = 20s;
/// Nothing goes on for so long: the operator stops the job.
constexpr Duration kStuck = 25s;
/// He believes that it helps so many times, while no line is answered.
constexpr int kMostResumesInVain = 20;
/// After a reset that wakes it, a machine speaks sooner.
constexpr Duration kPatienceWithSilence = 10s;
/// A report takes so long on a slow wire, behind what the controller says besides.
constexpr Duration kOnTheWay = 20ms;

class CampaignRun {
 public:
  CampaignRun(CampaignCase made_up, int most_resumes, bool keep_transcript)
      : most_resumes_(most_resumes),
        made_up_(with_transcript(std::move(made_up), keep_transcript)),
        wanted_(undisturbed(made_up_)),
        dice_(made_up_.seed ^ 0x9E3779B97F4A7C15U),
        world_(made_up_.world),
        watch_(wanted_.work_zero, kCampaignStepsPerMm),
        path_watch_(wanted_.path, kCampaignStepsPerMm, kOnTheWay + 2 * made_up_.world.wire.latency) {
    for (const auto& event : made_up_.workcell) world_.touch(event);
    must("seed " + std::to_string(made_up_.seed));
  }

  CampaignVerdict run() {
    verdict_.complaints = wanted_.complaints;
    if (!verdict_.complaints.empty()) return finish();
    if (connect() && start()) {
      run_to_the_end();
    } else {
      complain("the machine was not ready for the job, although nothing had struck it");
    }
    return finish();
  }

 private:
  static CampaignCase with_transcript(CampaignCase made_up, bool keep) {
    made_up.world.keeps_transcript = keep;
    return made_up;
  }

  // --- time ---

  void run_for(Duration time) {
    static_cast<void>(run_until([] { return false; }, time));
  }
  template <class Done>
  bool run_until(const Done& done, Duration limit) {
    const Instant end = world_.now() + limit;
    while (!done()) {
      const bool stepped = world_.step(end);
      look();
      if (!stepped) return done();
    }
    return true;
  }
  void look() {
    watch_.look(world_.now(), world_.controller(), world_.wire_watch().has_sent_motion());
    // A resumed job has a way of its own.
    if (watches_path_) path_watch_.look(world_);
  }

  // --- before the job ---

  bool connect() {
    world_.open();
    if (!run_until([this] { return world_.session().phase() == SessionPhase::Ready; }, kConnectLimit)) return false;
    if (made_up_.homes) world_.submit(session::Home{});
    run_for(500ms);
    return run_until(
        [this] {
          return world_.session().snapshot().state == vocabulary::MachineState::Idle &&
                 world_.session().ledger().empty() && !watch_.is_moving();
        },
        kConnectLimit);
  }

  bool start() {
    auto program = job::Program::load("part.nc", made_up_.program);
    if (!program) return false;
    program_ = *program;
    watches_path_ = true;
    const bool began = start({.program = program_, .options = {.on_error = job::ErrorPolicy::Stop}});
    for (const Fault& fault : made_up_.faults) due_.push_back({.at = job_began_ + instant_of(fault), .fault = &fault});
    return began;
  }

  bool start(const session::StartJob& command) {
    world_.submit(command);
    is_killed_ = false;
    // Behind lines by hand it begins a little later.
    const bool began = run_until([this] { return world_.session().job() && !is_over(); }, kStartLimit);
    job_began_ = moved_on_at_ = world_.now();
    return began;
  }

  // --- the job ---

  void run_to_the_end() {
    for (;;) {
      run_job();
      if (!is_killed_ && phase() == JobPhase::Finished) {
        verdict_.ending = verdict_.resumes == 0 ? CampaignEnding::Finished : CampaignEnding::Resumed;
        return;
      }
      run_for(kAfterwards);
      if (verdict_.resumes == most_resumes_) {
        verdict_.ending = CampaignEnding::TooOften;
        return;
      }
      put_everything_right();
      if (!make_ready()) {
        verdict_.ending = CampaignEnding::NotReady;
        return;
      }
      if (!resume()) return;
    }
  }

  // --- after an interruption ---

  void put_everything_right() {
    watches_path_ = false;
    world_.fill_disk(false);
    std::erase_if(due_, [](const Due& due) { return due.is_over; });
    for (const char* const order : {"faults off", "link restore", "door close", "power on"}) must(order);
    run_for(dice_.up_to(3s));
  }

  [[nodiscard]] bool is_silent() const { return world_.session().link_health(world_.now()).silent_for_s.has_value(); }
  [[nodiscard]] bool is_idle() const {
    return world_.session().phase() == SessionPhase::Ready && !is_silent() &&
           world_.session().snapshot().state == vocabulary::MachineState::Idle && world_.session().ledger().empty() &&
           !watch_.is_moving();
  }

  bool make_ready() {
    const auto ready = [this] { return world_.session().phase() == SessionPhase::Ready; };
    if (is_killed_ || world_.session().phase() == SessionPhase::Closed) world_.open();
    if (!run_until(ready, kConnectLimit)) {
      note("the operator resets");
      world_.submit(session::SoftReset{});
      if (!run_until(ready, kConnectLimit)) return false;
    }
    run_for(1s);
    if (!is_silent() || wake()) return rest_and_home();
    return false;
  }

  /// A Rabbit whose receive buffer is full while it waits behind a door or a hold reads no byte more, not even a reset.
  bool wake() {
    const auto answers = [this] { return world_.session().phase() == SessionPhase::Ready && !is_silent(); };
    note("the operator resets");
    world_.submit(session::SoftReset{});
    if (run_until(answers, kPatienceWithSilence)) return true;
    note("the operator switches it off and on");
    must("power off");
    run_for(1s);
    must("power on");
    run_for(1s);
    if (world_.session().phase() == SessionPhase::Closed) world_.open();
    if (!run_until(answers, kConnectLimit)) return false;
    run_for(1s);
    return true;
  }

  bool rest_and_home() {
    const auto ready = [this] { return world_.session().phase() == SessionPhase::Ready; };
    if (world_.session().snapshot().state != vocabulary::MachineState::Idle &&
        world_.session().snapshot().state != vocabulary::MachineState::Alarm) {
      note("the operator resets");
      world_.submit(session::SoftReset{});
      run_for(5s);
      if (!run_until(ready, kConnectLimit)) return false;
    }
    if (made_up_.homes) {
      world_.submit(session::Home{});
    } else if (world_.session().snapshot().state == vocabulary::MachineState::Alarm) {
      world_.submit(session::Unlock{});
    }
    run_for(1s);
    if (!run_until([this] { return is_idle(); }, kConnectLimit)) return false;
    run_for(3s);
    return is_idle();
  }

  /// Whether the controller's position is that of the motors.
  [[nodiscard]] bool is_where_it_says() const {
    const auto place = place_of(world_.controller());
    const auto machine = world_.controller().position_steps();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(place[axis] - wanted_.machine_zero[axis] - machine[axis]) > kSameSteps) return false;
    }
    return true;
  }

  bool resume() {
    const std::vector<job::JobHistory> jobs = world_.journal().jobs();
    if (jobs.empty()) {
      verdict_.ending = CampaignEnding::NotInJournal;
      return false;
    }
    const job::JobHistory* root = &jobs.back();
    while (root->begun.origin.continues) root = &jobs.at(static_cast<std::size_t>(*root->begun.origin.continues) - 1);
    const auto& session = world_.session();
    auto facts =
        job::facts_of_job(jobs.back(), root->begun.machine, *program_, session.snapshot(), session.capabilities());
    facts.silent_for_s = session.link_health(world_.now()).silent_for_s;
    const auto plan = job::plan_resume(
        *program_, facts, {.offsets = job::OffsetsChoice::AsThen, .position_is_confirmed = is_where_it_says()});
    if (!plan) {
      note("no plan: " + plan.error().sentence);
      verdict_.refusal = boost::describe::enum_to_string(plan.error().problem, "?");
      // A job of which nothing is left has been cut, whatever the journal calls it.
      const bool is_done = plan.error().problem == job::ResumeProblem::NothingLeft;
      verdict_.ending = is_done ? CampaignEnding::Resumed : CampaignEnding::Refused;
      return false;
    }
    for (const std::string& line : job::text_of(*plan)) note("plan: " + line);
    ++verdict_.resumes;
    job::ResumedProgram resumed = job::resumed_program(*program_, *plan);
    resumed.origin.continues = static_cast<std::int64_t>(jobs.size());
    resumed.origin.file_hash = program_->hash();
    if (start({.program = resumed.program, .origin = resumed.origin, .options = {.on_error = job::ErrorPolicy::Stop}}))
      return true;
    if (is_finished_at_once()) return true;
    complain("a plan was made, and its job was not taken");
    return false;
  }

  [[nodiscard]] bool is_finished_at_once() const { return world_.session().job() && phase() == JobPhase::Finished; }

  void run_job() {
    const Instant limit = job_began_ + kSlowestJob * wanted_.takes + kPatience;
    while (!is_over() && world_.now() < limit) {
      run_for(std::min(next_due() - world_.now(), kOperatorLooks));
      strike();
      operate();
    }
    if (!is_over()) complain("the job never came to an end; " + standing());
  }

  [[nodiscard]] Duration instant_of(const Fault& fault) const {
    return Duration{
        static_cast<Duration::rep>(std::max(fault.at_share, 0.0) * static_cast<double>(wanted_.takes.count()))};
  }

  [[nodiscard]] Instant next_due() const {
    Instant next = kNever;
    for (const Due& due : due_) next = std::min(next, due.at);
    return std::max(next, world_.now());
  }

  void strike() {
    for (std::size_t i = 0; i < due_.size();) {
      if (due_[i].at > world_.now() || is_over()) {
        ++i;
        continue;
      }
      const Due due = due_[i];
      due_.erase(due_.begin() + static_cast<std::ptrdiff_t>(i));
      due.is_over ? put_right(*due.fault) : strike(*due.fault);
    }
  }

  void strike(const Fault& fault) {
    verdict_.struck.push_back(fault.kind);
    note("strikes: " + std::string{name_of(fault.kind)} + " " + fault.order);
    if (changes_bytes(fault.kind) && !fault.order.contains(" from")) bytes_changed_ = true;
    if (fault.kind == FaultKind::LinkSilent) lines_lost_ = true;
    // Its position is lost, and with it the place on the path.
    if (fault.kind == FaultKind::PowerLoss) watches_path_ = false;
    if (!fault.order.empty()) must(fault.order);
    switch (fault.kind) {
      case FaultKind::Kill:
        world_.kill_sender();
        is_killed_ = true;
        return;
      case FaultKind::Hold: world_.submit(session::HoldJob{}); break;
      case FaultKind::Stop: world_.submit(session::StopJob{}); return;
      case FaultKind::Abort: world_.submit(session::AbortJob{}); return;
      case FaultKind::Override: turn_overrides(); return;
      case FaultKind::DiskFull: world_.fill_disk(true); break;
      default: break;
    }
    due_.push_back({.at = world_.now() + fault.lasts, .fault = &fault, .is_over = true});
  }

  void turn_overrides() {
    for (int turns = dice_.between(1, 6); turns > 0; --turns) {
      world_.submit(session::SendRealtime{
          static_cast<std::uint8_t>(dice_.pick({0x90, 0x91, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97, 0x9A, 0x9B}))});
    }
  }

  void put_right(const Fault& fault) {
    note("is over: " + std::string{name_of(fault.kind)});
    switch (fault.kind) {
      case FaultKind::LinkSilent:
      case FaultKind::LinkCut: must("link restore"); break;
      case FaultKind::PowerLoss: must("power on"); break;
      case FaultKind::BytesLost:
      case FaultKind::BytesDoubled:
      case FaultKind::BytesCorrupted: must("faults off"); break;
      case FaultKind::Door: must("door close"); break;
      case FaultKind::DiskFull: world_.fill_disk(false); break;
      default: break;
    }
  }

  /// What a patient operator does when he looks at the machine.
  void operate() {
    if (is_over()) return;
    follow_progress();
    const bool waits = phase() == JobPhase::Held;
    const bool something_is_wrong =
        std::ranges::any_of(due_, [](const Due& due) { return due.is_over && due.fault->kind != FaultKind::DiskFull; });
    if (waits && !something_is_wrong) {
      decide();
    } else if (!waits && world_.now() - moved_on_at_ > kStuck && phase() != JobPhase::Stopping) {
      note("the operator stops a job that does not go on");
      world_.submit(session::StopJob{});
    }
  }

  /// Goes on where Kerf says that it is safe, as it says; else he stops.
  void decide() {
    const auto& job = *world_.session().job();
    const bool is_stalled = job.hold_cause == job::HoldCause::Stall;
    const bool is_off_path = job.hold_cause == job::HoldCause::OffPath;
    was_held_off_path_ = was_held_off_path_ || is_off_path;
    if (is_off_path || (is_stalled && !(job.stall && job.stall->goes_on_at))) {
      note("the operator stops a job that cannot go on");
      world_.submit(session::StopJob{});
      return;
    }
    if (++resumes_in_vain_ > kMostResumesInVain) {
      note("the operator gives up on a machine that does not obey");
      world_.submit(session::AbortJob{});
      return;
    }
    note("the operator resumes");
    world_.submit(session::ResumeJob{});
  }

  void follow_progress() {
    const auto& job = *world_.session().job();
    const bool goes_on =
        job.progress.lines_acknowledged != lines_acknowledged_ || job.phase != last_phase_ || watch_.is_moving();
    if (goes_on) moved_on_at_ = world_.now();
    if (job.progress.lines_acknowledged != lines_acknowledged_) resumes_in_vain_ = 0;
    lines_acknowledged_ = job.progress.lines_acknowledged;
    last_phase_ = job.phase;
  }

  [[nodiscard]] JobPhase phase() const { return world_.session().job()->phase; }
  [[nodiscard]] bool is_over() const { return is_killed_ || job::is_final(phase()); }

  // --- the verdict ---

  CampaignVerdict finish() {
    verdict_.took = world_.now() - job_began_;
    take(world_.wire_watch().complaints());
    take(world_.line_watch().broken());
    take(path_watch_.complaints());
    judge_ledger();
    judge_path();
    const bool was_off_path = path_watch_.was_off() || was_held_off_path_;
    // Where a changed byte stops the spindle, makes a cut a rapid or leaves out a cut and the way back, the path is the
    // same and the workpiece is not.
    verdict_.cut_amiss = bytes_changed_ && !watch_.complaints().empty();
    verdict_.unjudged = (bytes_changed_ && (was_off_path || verdict_.resumes > 0)) || (lines_lost_ && was_off_path) ||
                        verdict_.cut_amiss;
    if (!bytes_changed_) take(watch_.complaints());
    if (!verdict_.unjudged) judge_cut();
    const bool nothing_else =
        std::ranges::all_of(verdict_.struck, [](auto kind) { return kind == FaultKind::DiskFull; });
    if (nothing_else && verdict_.ending != CampaignEnding::Finished) complain("the job did not end in one piece");
    verdict_.transcript = world_.transcript_text();
    for (const auto& record : world_.log()) {
      verdict_.transcript += base::to_fixed(base::to_seconds(record.at), 3) + " " + record.what + "\n";
    }
    if (made_up_.world.keeps_transcript) verdict_.transcript += notes_of(world_.journal());
    return std::move(verdict_);
  }

  void judge_ledger() {
    const auto& ledger = world_.session().ledger();
    if (ledger.lines_entered() != ledger.lines_settled() + ledger.lines_struck_out() + ledger.size()) {
      complain("the ledger does not add up");
    }
  }

  void judge_path() {
    verdict_.left_path = path_watch_.was_off_in_job();
    if (verdict_.left_path && !bytes_changed_ && !lines_lost_)
      complain("the machine left its path, and nothing led to it");
  }

  void judge_cut() {
    const CutDifference difference = compare(wanted_.stock, watch_.stock());
    if (difference.excess_cells > 0) {
      complain(std::to_string(difference.excess_cells) + " cells were cut that the job does not cut, one at " +
               text_of(difference.excess));
    }
    const bool is_done = verdict_.ending == CampaignEnding::Finished || verdict_.ending == CampaignEnding::Resumed;
    if (is_done && difference.missing_cells > 0 && bytes_changed_) {
      verdict_.cut_amiss = true;
    } else if (is_done && difference.missing_cells > 0) {
      complain(std::to_string(difference.missing_cells) + " cells were left uncut, one at " +
               text_of(difference.missing));
    }
  }

  [[nodiscard]] std::string standing() const {
    std::string text{boost::describe::enum_to_string(phase(), "?")};
    text += ", machine ";
    return text + boost::describe::enum_to_string(world_.controller().state(), "?");
  }

  void take(const std::vector<std::string>& complaints) {
    verdict_.complaints.insert(verdict_.complaints.end(), complaints.begin(), complaints.end());
  }
  void complain(std::string what) { verdict_.complaints.push_back(std::move(what)); }
  void note(const std::string& what) { must("note " + what); }
  void must(const std::string& order) {
    if (!world_.order(order)) complain("no such order: " + order);
  }

  struct Due {
    Instant at{};
    const Fault* fault = nullptr;
    bool is_over = false;
  };

  int most_resumes_;
  CampaignCase made_up_;
  UndisturbedJob wanted_;
  Dice dice_;
  World world_;
  CutterWatch watch_;
  DepartureWatch path_watch_;
  CampaignVerdict verdict_;
  std::shared_ptr<const job::Program> program_;
  std::vector<Due> due_;
  Instant job_began_{};
  Instant moved_on_at_{};
  std::uint32_t lines_acknowledged_ = 0;
  int resumes_in_vain_ = 0;
  JobPhase last_phase_{};
  bool is_killed_ = false;
  bool watches_path_ = false;
  /// On their way to the controller.
  bool bytes_changed_ = false;
  bool lines_lost_ = false;
  bool was_held_off_path_ = false;
};

}  // namespace

CampaignVerdict judge(CampaignCase made_up, int most_resumes, bool keep_transcript) {
  return CampaignRun{std::move(made_up), most_resumes, keep_transcript}.run();
}

}  // namespace kerf::simulation
