#include "sender/machine/explanation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sender/machine/explanation_evidence.hpp"
#include "sender/machine/lexicon.hpp"
#include "sender/machine/line_tracker.hpp"
#include "sender/machine/realtime_alphabet.hpp"

namespace kerf::machine {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using vocabulary::Firmware;

Capabilities with_settings(std::vector<std::pair<std::string, std::string>> values) {
  Capabilities known;
  for (auto& [id, value] : values) known.settings.push_back({.id = id, .value = value});
  return known;
}

Snapshot at_rest() {
  Snapshot snapshot;
  snapshot.state = vocabulary::MachineState::Idle;
  snapshot.machine_position_mm = {{-100, -100, -5}};
  snapshot.work_offset_mm = {{-100, -100, -50}};
  snapshot.offsets_mm = {{"G54", {-100, -100, -50}}, {"G92", {0, 0, 0}}};
  snapshot.tool_length.offset_mm = {{0}};
  snapshot.work_coordinate_system = "G54";
  snapshot.parser_words = {"G0", "G54", "G17", "G21", "G90", "G94", "M5", "M9", "T0", "F0", "S0"};
  snapshot.modes = {.motion = "G0",
                    .work_coordinates = "G54",
                    .plane = "G17",
                    .units = "G21",
                    .distance = "G90",
                    .feed_mode = "G94",
                    .feed_mm_per_min = 0};
  snapshot.inputs = Inputs{};
  return snapshot;
}

Explanation explain_alarm(Incident incident, const Snapshot& now, const Capabilities& known,
                          Firmware firmware = Firmware::Grbl) {
  const auto& dialect = vocabulary::dialect_of(firmware);
  return explain(incident, Lexicon{}.alarm(dialect, incident.code),
                 {.dialect = dialect, .capabilities = known, .now = now});
}

TEST(Explanation, AHardLimitNamesTheSwitch) {
  Snapshot now = at_rest();
  now.pins = "X";
  now.inputs->limits = "X";
  const auto told = explain_alarm({.code = 1, .before = at_rest()}, now, {});
  EXPECT_EQ(told.headline, "Alarm 1: the limit switch of X is pressed.");
  EXPECT_EQ(told.position, PositionTrust::Unknown);
  EXPECT_THAT(told.evidence, Contains("Active inputs: X limit."));
}

TEST(Explanation, AHardLimitInTheMiddleOfTheTravelLooksLikeNoise) {
  const auto known = with_settings({{"130", "200"}, {"131", "200"}, {"132", "60"}});
  Snapshot before = at_rest();
  before.machine_position_mm = {{-100, -100, -30}};
  const auto told = explain_alarm({.code = 1, .before = before}, before, known);
  EXPECT_THAT(told.evidence, Contains(HasSubstr("noise")));
}

TEST(Explanation, ASoftLimitBecauseOfTheWorkZero) {
  const auto known = with_settings({{"130", "200"}, {"131", "200"}, {"132", "60"}});
  const auto told = explain_alarm({.code = 2,
                                   .culprit = IncidentLine{.file_line = 7, .text = "G1Z-20"},
                                   .targets_mm = {{-100, -100, -70}},
                                   .before = at_rest()},
                                  at_rest(), known);
  EXPECT_EQ(told.headline, "Alarm 2 at line 7: Z-70 is 10 mm below the travel because the work zero (G54) is at Z-50.");
}

TEST(Explanation, ASoftLimitBecauseTheProgramIsTooLarge) {
  const auto known = with_settings({{"130", "200"}});
  const auto told = explain_alarm(
      {.code = 2, .culprit = IncidentLine{.text = "G0X300"}, .targets_mm = {{200, -100, -5}}, .before = at_rest()},
      at_rest(), known);
  EXPECT_THAT(told.headline, HasSubstr("X200 is 200 mm above the travel"));
  EXPECT_THAT(told.headline, HasSubstr("more than the axis is long (200 mm)"));
}

TEST(Explanation, GrblHalsTravelEndsAtThePullOff) {
  const auto known = with_settings({{"21", "1"}, {"22", "9"}, {"23", "1"}, {"27", "2"}, {"130", "200"}});
  const auto& dialect = vocabulary::dialect_of(Firmware::GrblHal);
  const Snapshot snapshot = at_rest();
  const MachineKnowledge machine{.dialect = dialect, .capabilities = known, .now = snapshot};
  EXPECT_FALSE(worst_excess({{198, 0, 0}}, machine));
  ASSERT_TRUE(worst_excess({{199, 0, 0}}, machine));
  EXPECT_NEAR(worst_excess({{199, 0, 0}}, machine)->excess_mm, 1, 1e-3);
  ASSERT_TRUE(worst_excess({{-1, 0, 0}}, machine));
}

TEST(Explanation, RabbitsTravelBeginsAtTheSwitchWhereverThatIs) {
  auto known = with_settings({{"23", "1"}, {"130", "200"}, {"X/Home/Mpos", "-50.000"}});
  const auto& dialect = vocabulary::dialect_of(Firmware::Rabbit);
  const Snapshot snapshot = at_rest();
  const MachineKnowledge machine{.dialect = dialect, .capabilities = known, .now = snapshot};
  EXPECT_FALSE(worst_excess({{149, 0, 0}}, machine));
  ASSERT_TRUE(worst_excess({{-52, 0, 0}}, machine));
  EXPECT_NEAR(worst_excess({{-52, 0, 0}}, machine)->excess_mm, -2, 1e-3);
}

TEST(Explanation, AnAlarmWithoutANumberIsExplainedAllTheSame) {
  const auto told = explain_alarm({.code = 0, .before = at_rest()}, at_rest(), {});
  EXPECT_THAT(told.headline, HasSubstr("Alarm"));
  EXPECT_THAT(told.next_steps, Not(IsEmpty()));
}

TEST(Explanation, EveryAlarmOfEveryFirmwareHasAdvice) {
  for (const auto* dialect : vocabulary::all_dialects()) {
    for (const auto& row : dialect->alarms) {
      const auto told = explain_code(IncidentKind::Alarm, Lexicon{}.alarm(*dialect, row.code), *dialect);
      EXPECT_FALSE(told.headline.empty());
      EXPECT_FALSE(told.next_steps.empty()) << dialect->name << " " << row.code;
      EXPECT_THAT(told.next_steps, Not(Contains(HasSubstr("Find the cause before")))) << dialect->name << row.code;
    }
    for (const auto& row : dialect->errors) {
      EXPECT_FALSE(explain_code(IncidentKind::Error, Lexicon{}.error(*dialect, row.code), *dialect).headline.empty());
    }
  }
}

TEST(LineTracker, FollowsOffsetsUnitsAndIncrements) {
  LineTracker tracker;
  const auto& grbl = vocabulary::dialect_of(Firmware::Grbl);
  tracker.seed(at_rest(), grbl);
  ASSERT_TRUE(tracker.knows());
  tracker.on_accepted("G1X10Y0Z0F100");
  EXPECT_THAT(tracker.targets_of("G91G20X1"), ElementsAre(ElementsAre(testing::DoubleNear(-64.6, 1e-3), -100, -50)));
  EXPECT_THAT(tracker.targets_of("G53G0Z-1"), ElementsAre(ElementsAre(-90, -100, -1)));
  EXPECT_THAT(tracker.targets_of("$J=G91X-5F100"), ElementsAre(ElementsAre(-95, -100, -50)));
  tracker.on_accepted("G10L20P1X0");
  EXPECT_THAT(tracker.targets_of("G0X1"), ElementsAre(ElementsAre(-89, -100, -50)));
  tracker.on_accepted("G38.2Z-10");
  EXPECT_FALSE(tracker.knows()) << "nobody knows where a probe stops";
}

TEST(LineTracker, SaysNothingWhereTheOffsetsDoNotAddUp) {
  LineTracker tracker;
  Snapshot snapshot = at_rest();
  (*snapshot.work_offset_mm)[0] += 1;
  tracker.seed(snapshot, vocabulary::dialect_of(Firmware::Grbl));
  EXPECT_FALSE(tracker.knows());
}

TEST(RealtimeAlphabet, EachFirmwareHasItsOwn) {
  using vocabulary::Realtime;
  const auto& grbl = vocabulary::dialect_of(Firmware::Grbl);
  const auto& hal = vocabulary::dialect_of(Firmware::GrblHal);
  EXPECT_EQ(byte_for(Realtime::FeedHold, hal, false), '!');
  EXPECT_EQ(byte_for(Realtime::FeedHold, hal, true), 0x82);
  EXPECT_EQ(byte_for(Realtime::StatusQuery, hal, true), 0x80);
  EXPECT_EQ(byte_for(Realtime::CycleStart, hal, true), 0x81);
  EXPECT_EQ(byte_for(Realtime::SoftReset, hal, true), 0x18);
  EXPECT_EQ(byte_for(Realtime::FeedHold, grbl, true), '!');
  EXPECT_TRUE(carries_text("$75=secret"));
  EXPECT_TRUE(carries_text("G0X1(MSG,hello)"));
  EXPECT_FALSE(carries_text("G0X1"));
}

TEST(RealtimeAlphabet, SaysWhatWouldBeEaten) {
  const auto& grbl = vocabulary::dialect_of(Firmware::Grbl);
  const auto& hal = vocabulary::dialect_of(Firmware::GrblHal);
  EXPECT_FALSE(why_eaten("G0X1", grbl, false));
  EXPECT_THAT(why_eaten("$I=a!b", grbl, false).value_or(""), HasSubstr("feed hold"));
  EXPECT_THAT(why_eaten("$I=a~b", hal, false).value_or(""), HasSubstr("$39=0"));
  EXPECT_FALSE(why_eaten("$I=a!b?c~d", hal, true));
  EXPECT_FALSE(why_eaten("G0X1(MSG, ready?)", hal, true));
  EXPECT_TRUE(why_eaten("G0X1(done)!", hal, true));
  EXPECT_TRUE(why_eaten("G0X1;(what?)", hal, true));
  EXPECT_THAT(why_eaten("$I=caf\xC3\xA9", hal, true).value_or(""), HasSubstr("\\xC3"));
}

TEST(ExplanationDetails, DoNotSayTheHeadlineAgain) {
  Explanation told;
  told.headline = "Error 20: Unsupported g-code.";
  told.title = "Unsupported g-code";
  told.text = "Unsupported g-code. Remove it.";
  EXPECT_THAT(details_of(told), Contains("Remove it."));
  told.headline = "Error 20: G77 is not known.";
  EXPECT_THAT(details_of(told), Contains("Unsupported g-code. Remove it."));
  told.text = "Remove it.";
  EXPECT_THAT(details_of(told), Contains("Unsupported g-code. Remove it."));
  told.title.clear();
  EXPECT_THAT(details_of(told), Contains("Remove it."));
}

}  // namespace
}  // namespace kerf::machine
