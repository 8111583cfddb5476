// The position audit on all three firmwares: it finds what the motors lost, to the step, and nothing where nothing was
// lost.

#include <chrono>
#include <map>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/time.hpp"
#include "scenario.hpp"
#include "sender/job/audit_plan.hpp"
#include "sender/job/position_audit.hpp"
#include "sender/session/audit_talk.hpp"

namespace kerf::scenarios {
namespace {

using namespace std::chrono_literals;
using job::AuditOutcome;
using job::AxisVerdict;
using vocabulary::Firmware;
using vocabulary::MachineState;

/// Where the switches are and what guards them.
struct Machine {
  const char* name = "";
  std::map<std::string, std::string> settings;
};

const std::vector<Machine>& machines() {
  static const std::vector<Machine> all{
      {.name = "Plain", .settings = {}},
      {.name = "Guarded", .settings = {{"20", "1"}, {"21", "1"}}},
      {.name = "HomesXToMinus", .settings = {{"23", "1"}, {"20", "1"}, {"21", "1"}}},
      {.name = "LongPullOff", .settings = {{"27", "5.000"}}},
  };
  return all;
}

WorldOptions options_of(Firmware firmware, const Machine& machine) {
  auto options = quick_serial(firmware);
  auto& settings = options.stored.settings;
  settings["22"] = "1";
  settings["24"] = "100.000";
  settings["25"] = "2000.000";
  settings["23"] = "0";
  settings["26"] = "50";
  settings["27"] = "1.000";
  for (const char* const axis : {"130", "131", "132"}) settings[axis] = "60.000";
  for (const auto& [id, value] : machine.settings) settings[id] = value;
  return options;
}

/// The audit beside the session, as `kerf audit` has it.
class Auditor {
 public:
  Auditor(World& world, job::AuditPlan plan) : world_(world), audit_(world.now(), std::move(plan)) { obey(); }

  bool step() {
    const bool goes_on = world_.step(std::min(audit_.next_deadline(), world_.now() + 1s));
    static_cast<void>(goes_on);
    for (; seen_ < world_.events().size(); ++seen_) {
      const session::Event event = world_.events()[seen_];
      session::tell_audit(audit_, world_.now(), event, world_.session().snapshot());
    }
    if (audit_.next_deadline() <= world_.now()) audit_.advance_to(world_.now());
    obey();
    return !audit_.is_over();
  }

  const job::AuditResult& run(Duration limit = 20min) {
    const Instant end = world_.now() + limit;
    while (step() && world_.now() < end) {
      if (world_.session().snapshot().state == MachineState::Alarm) ++alarms_;
    }
    return audit_.result();
  }

  job::PositionAudit& audit() { return audit_; }
  [[nodiscard]] int alarms() const { return alarms_; }

 private:
  void obey() {
    for (const job::AuditOrder& order : audit_.take_orders()) {
      if (const auto command = session::command_of(order)) world_.submit(*command);
    }
  }

  World& world_;
  std::size_t seen_ = world_.events().size();
  job::PositionAudit audit_;
  int alarms_ = 0;
};

bool is_homed(const simulation::World& world) {
  return world.session().snapshot().state == MachineState::Idle && world.session().snapshot().homing.all == true;
}

/// Connects, homes, and works a little away from the switches.
bool prepare(World& world) {
  if (!connect(world)) return false;
  world.run_for(1s);
  world.submit(session::Home{});
  if (!world.run_until(is_homed, 5min)) return false;
  world.run_for(2s);
  return true;
}

/// Away from the corner; `mirrored` axes home towards minus.
void work(World& world, const Machine& machine) {
  const bool mirrors_x = machine.settings.contains("23");
  world.submit(session::Jog{std::string{"G21G91"} + (mirrors_x ? "X20" : "X-20") + "Y-20Z-20F3000"});
  world.run_for(5s);
}

/// What the settings that stop a machine at its switches are now.
std::map<std::string, std::string> guards_of(const World& world) {
  std::map<std::string, std::string> found;
  for (const char* const id : {"20", "21", "40"}) {
    const auto* const fact = world.session().capabilities().find_setting(id);
    if (fact != nullptr && fact->value) found[id] = *fact->value;
  }
  return found;
}

class Audits : public testing::TestWithParam<std::tuple<Firmware, Machine>> {
 protected:
  Audits() : world_(options_of(std::get<0>(GetParam()), std::get<1>(GetParam()))) {}

  [[nodiscard]] std::map<std::string, std::string> guards() const { return guards_of(world_); }

  job::AuditResult audit() {
    const auto plan = job::plan_audit(world_.session().capabilities(), world_.session().snapshot());
    EXPECT_TRUE(plan) << plan.error();
    if (!plan) return {};
    Auditor auditor(world_, *plan);
    auto result = auditor.run();
    EXPECT_EQ(auditor.alarms(), 0);
    return result;
  }

  World world_;
};

INSTANTIATE_TEST_SUITE_P(Machines, Audits,
                         testing::Combine(testing::ValuesIn(kFirmwares), testing::ValuesIn(machines())),
                         [](const auto& param) {
                           return word_for(std::get<0>(param.param)) + std::get<1>(param.param).name;
                         });

TEST_P(Audits, FindsNothingWhereNothingWasLost) {
  ASSERT_TRUE(prepare(world_));
  work(world_, std::get<1>(GetParam()));
  const auto before = guards();
  const job::AuditResult result = audit();
  EXPECT_EQ(result.outcome, AuditOutcome::Kept) << result.sentence;
  ASSERT_EQ(result.axes.size(), 3U);
  for (const auto& axis : result.axes) EXPECT_EQ(axis.difference_steps, 0) << job::sentence_of(axis);
  EXPECT_EQ(guards(), before);
}

TEST_P(Audits, FindsExactlyWhatWasLost) {
  ASSERT_TRUE(prepare(world_));
  work(world_, std::get<1>(GetParam()));
  ASSERT_TRUE(world_.order("lose X 40"));
  ASSERT_TRUE(world_.order("lose Y -325"));
  ASSERT_TRUE(world_.order("lose Z 3"));
  const auto before = guards();
  const job::AuditResult result = audit();
  EXPECT_EQ(result.outcome, AuditOutcome::Shifted) << result.sentence;
  ASSERT_EQ(result.axes.size(), 3U);
  std::map<std::string, std::int64_t> found;
  for (const auto& axis : result.axes) found[axis.axis] = axis.difference_steps.value_or(99999);
  EXPECT_EQ(found, (std::map<std::string, std::int64_t>{{"X", -40}, {"Y", 325}, {"Z", -3}}));
  EXPECT_EQ(result.axes[0].axis, "Z");
  EXPECT_EQ(result.axes[0].verdict, AxisVerdict::Kept);  // within the tolerance
  EXPECT_EQ(guards(), before);
  // It knows where it is now.
  const job::AuditResult again = audit();
  EXPECT_EQ(again.outcome, AuditOutcome::Kept) << again.sentence;
  for (const auto& axis : again.axes) EXPECT_EQ(axis.difference_steps, 0) << job::sentence_of(axis);
}

TEST_P(Audits, MeetsASwitchThatIsMuchNearerThanBelieved) {
  ASSERT_TRUE(prepare(world_));
  work(world_, std::get<1>(GetParam()));
  const bool up = std::string_view{std::get<1>(GetParam()).name} != "HomesXToMinus";
  ASSERT_TRUE(world_.order(up ? "lose X -2500" : "lose X 2500"));
  const job::AuditResult result = audit();
  EXPECT_EQ(result.outcome, AuditOutcome::Shifted) << result.sentence;
  ASSERT_EQ(result.axes.size(), 3U);
  EXPECT_EQ(result.axes[1].difference_steps, up ? 2500 : -2500);
}

TEST_P(Audits, GivesUpWhereTheSwitchDoesNotCome) {
  ASSERT_TRUE(prepare(world_));
  work(world_, std::get<1>(GetParam()));
  ASSERT_TRUE(world_.order("switch Z none"));
  const auto before = guards();
  const job::AuditResult result = audit();
  EXPECT_EQ(result.outcome, AuditOutcome::Failed);
  EXPECT_THAT(result.sentence, testing::HasSubstr("The switch of Z did not close within 3 mm"));
  EXPECT_EQ(guards(), before);
  EXPECT_TRUE(result.left_off.empty());
}

TEST_P(Audits, PutsEverythingBackWheneverItIsStopped) {
  for (Duration after = 200ms; after < 60s; after += 2900ms) {
    World world{options_of(std::get<0>(GetParam()), std::get<1>(GetParam()))};
    ASSERT_TRUE(prepare(world));
    work(world, std::get<1>(GetParam()));
    const auto before = guards_of(world);
    const auto plan = job::plan_audit(world.session().capabilities(), world.session().snapshot());
    ASSERT_TRUE(plan);
    Auditor auditor(world, *plan);
    const Instant at = world.now() + after;
    bool goes_on = true;
    while (goes_on && world.now() < at) goes_on = auditor.step();
    if (!goes_on) return;
    auditor.audit().stop(world.now());
    const job::AuditResult& result = auditor.run();
    EXPECT_EQ(result.outcome, AuditOutcome::Stopped);
    EXPECT_EQ(guards_of(world), before) << base::to_seconds(after) << " s: " << result.sentence;
    EXPECT_TRUE(result.left_off.empty()) << base::to_seconds(after) << " s: " << result.sentence;
  }
}

TEST_P(Audits, FailsWhenTheMachineRestarts) {
  ASSERT_TRUE(prepare(world_));
  const auto plan = job::plan_audit(world_.session().capabilities(), world_.session().snapshot());
  ASSERT_TRUE(plan);
  Auditor auditor(world_, *plan);
  const Instant at = world_.now() + 3s;
  while (auditor.step() && world_.now() < at) {
  }
  ASSERT_TRUE(world_.order("reboot"));
  const job::AuditResult& result = auditor.run();
  EXPECT_EQ(result.outcome, AuditOutcome::Failed);
  EXPECT_FALSE(result.sentence.empty());
  EXPECT_FALSE(result.is_homed);
}

}  // namespace
}  // namespace kerf::scenarios
