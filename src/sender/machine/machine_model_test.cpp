#include "sender/machine/machine_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"
#include "sender/machine/lexicon.hpp"

namespace kerf::machine {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Optional;
using vocabulary::MachineState;

/// One that knows that positions are in millimetres.
MachineModel model_in_mm() {
  MachineModel model;
  model.fold(Instant{}, protocol::decode("$13=0"));
  return model;
}

class MachineModelTest : public testing::Test {
 protected:
  void hear(std::string_view line) { model_.fold(Instant{}, protocol::decode(line)); }
  const Snapshot& known() const { return model_.snapshot(); }
  MachineModel model_ = model_in_mm();
};

TEST_F(MachineModelTest, WorkPositionFollowsTheLastOffset) {
  hear("<Idle|MPos:10.000,20.000,30.000|FS:0,0>");
  EXPECT_FALSE(known().work_position_mm);
  hear("<Idle|MPos:10.000,20.000,30.000|FS:0,0|WCO:1.000,2.000,3.000>");
  EXPECT_THAT(known().work_position_mm, Optional(ElementsAre(9, 18, 27)));
  hear("<Run|MPos:11.000,20.000,30.000|FS:0,0>");
  EXPECT_THAT(known().work_position_mm, Optional(ElementsAre(10, 18, 27)));
}

TEST_F(MachineModelTest, MachinePositionFollowsFromAWorkPosition) {
  hear("<Idle|WPos:1.000,1.000,1.000|FS:0,0|WCO:5.000,6.000,7.000>");
  EXPECT_THAT(known().machine_position_mm, Optional(ElementsAre(6, 7, 8)));
  // `$10` was changed in the middle of the session.
  hear("<Idle|MPos:5.000,5.000,5.000|FS:0,0>");
  EXPECT_THAT(known().work_position_mm, Optional(ElementsAre(0, -1, -2)));
}

TEST_F(MachineModelTest, UnitsSetByTheirNameAreSet) {
  model_.speak(vocabulary::dialect_of(vocabulary::Firmware::Rabbit));
  model_.on_line_accepted("$Report/Inches=1");
  EXPECT_TRUE(known().reports_inches);
  model_.on_line_accepted("$report/inches=0");
  EXPECT_FALSE(known().reports_inches);
}

TEST_F(MachineModelTest, InchesBecomeMillimetres) {
  model_.forget();
  hear("<Idle|MPos:1.000,0.000,0.000|FS:10.0,0|WCO:0.000,0.000,0.000>");
  // Nobody has said what they mean.
  EXPECT_FALSE(known().machine_position_mm);
  EXPECT_FALSE(known().feed_mm_per_min);
  EXPECT_THAT(known().machine_position_unitless, Optional(ElementsAre(1, 0, 0)));
  hear("$13=1");
  EXPECT_FALSE(known().machine_position_unitless);
  // It was inches all the time.
  EXPECT_THAT(known().machine_position_mm, Optional(ElementsAre(DoubleNear(25.4, 1e-9), 0, 0)));
  hear("<Idle|MPos:1.0000,0.0000,0.0000|FS:10.0,0|WCO:0.0000,0.0000,0.0000>");
  EXPECT_THAT(known().machine_position_mm, Optional(ElementsAre(DoubleNear(25.4, 1e-9), 0, 0)));
  EXPECT_THAT(known().feed_mm_per_min, Optional(DoubleNear(254, 1e-9)));
  model_.on_line_accepted("$13 = 0");
  EXPECT_FALSE(known().reports_inches);
  // A report may have been on its way when that was answered.
  EXPECT_FALSE(known().machine_position_mm);
}

TEST_F(MachineModelTest, AbsentInputsAreOffAndOverridesWithoutAccessoriesMeanAllOff) {
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|Pn:XP|Ov:100,100,100|A:SF>");
  EXPECT_EQ(known().pins, "XP");
  ASSERT_TRUE(known().inputs && known().accessories);
  EXPECT_EQ(known().inputs->limits, "X");
  EXPECT_TRUE(known().inputs->probe);
  EXPECT_EQ(known().accessories->spindle, SpindleTurn::Clockwise);
  EXPECT_TRUE(known().accessories->flood);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_EQ(known().pins, "");
  EXPECT_EQ(known().inputs, Inputs{});
  EXPECT_TRUE(known().accessories->flood);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|Ov:90,50,100>");
  EXPECT_EQ(known().accessories, Accessories{});
  EXPECT_EQ(known().overrides, (OverridePercentages{.feed = 90, .rapid = 50, .spindle = 100}));
}

TEST_F(MachineModelTest, AlarmStaysUntilAnotherStateIsReported) {
  model_.speak(vocabulary::dialect_of(vocabulary::Firmware::Grbl));
  hear("ALARM:1");
  EXPECT_EQ(known().state, MachineState::Alarm);
  EXPECT_EQ(known().alarm_code, 1);
  EXPECT_TRUE(known().reset_required);
  hear("<Alarm|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_EQ(known().alarm_code, 1);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_FALSE(known().alarm_code);
  EXPECT_FALSE(known().reset_required);
}

TEST_F(MachineModelTest, APendantIsSeenAndReleased) {
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:1>");
  EXPECT_TRUE(known().pendant_in_control);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_TRUE(known().pendant_in_control);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|MPG:0>");
  EXPECT_FALSE(known().pendant_in_control);
}

TEST_F(MachineModelTest, AFileOnTheCardIsSeen) {
  hear("<Run|MPos:0.000,0.000,0.000|FS:0,0|SD:10.5,part.nc>");
  EXPECT_EQ(known().controller_file, "part.nc");
  EXPECT_EQ(known().card.file_percent, 10.5);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|SD:1>");
  EXPECT_EQ(known().controller_file, "");
  EXPECT_EQ(known().card.mounted, true);
  EXPECT_EQ(known().card.detected, false);
  EXPECT_TRUE(known().parser_state_is_old) << "the file may have changed every mode";
}

TEST_F(MachineModelTest, ParserStateGivesWorkCoordinatesAndTool) {
  hear("[GC:G0 G59.3 G17 G21 G90 G94 M5 M9 T7 F0 S0.]");
  EXPECT_EQ(known().work_coordinate_system, "G59.3");
  EXPECT_EQ(known().tool, 7);
  EXPECT_EQ(known().modes.units, "G21");
  EXPECT_EQ(known().modes.coolant, "M9");
  EXPECT_EQ(known().modes.spindle_rpm, 0);
}

TEST_F(MachineModelTest, LinesMakeModesAndOffsetsOldUntilTheyAreToldAgain) {
  hear("[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]");
  EXPECT_FALSE(known().parser_state_is_old);
  model_.on_line_accepted("$J=G91X1F100");
  EXPECT_FALSE(known().parser_state_is_old);
  model_.on_line_accepted("g10 l20 p1 x0");
  EXPECT_TRUE(known().parser_state_is_old);
  EXPECT_TRUE(known().offsets_are_old);
  hear("[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]");
  model_.on_line_accepted("$#");
  EXPECT_FALSE(known().parser_state_is_old);
  EXPECT_FALSE(known().offsets_are_old);
}

TEST_F(MachineModelTest, AResetForgetsWhatAResetMayClear) {
  hear("<Idle|MPos:1.000,2.000,3.000|WCO:1.000,1.000,1.000|Ov:50,50,50|A:F>");
  hear("[TLO:12.100]");
  hear("[PRB:1.000,2.000,3.000:1]");
  hear("Grbl 1.1h ['$' for help]");
  EXPECT_FALSE(known().work_position_mm);
  EXPECT_FALSE(known().tool_length.offset_mm);
  EXPECT_FALSE(known().overrides);
  EXPECT_FALSE(known().probe);
  hear("<Idle|MPos:1.000,2.000,3.000|FS:0,0>");
  EXPECT_FALSE(known().work_position_mm) << "the offset of before the reset is not the one of now";
}

TEST_F(MachineModelTest, HomingIsAccountedForWhereNobodyTells) {
  model_.speak(vocabulary::dialect_of(vocabulary::Firmware::Grbl));
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_FALSE(known().homing.all);
  model_.on_line_accepted("$H");
  EXPECT_EQ(known().homing.all, true);
  EXPECT_EQ(known().homing.axes, "XYZ");
  hear("ALARM:3");
  EXPECT_EQ(known().homing.all, false);
  model_.on_line_accepted("$HX");
  EXPECT_EQ(known().homing.axes, "X");
  EXPECT_FALSE(known().homing.is_told);
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0|H:0,6>");
  EXPECT_EQ(known().homing.axes, "YZ");
  EXPECT_TRUE(known().homing.is_told);
  model_.on_line_accepted("$HX");
  EXPECT_EQ(known().homing.axes, "YZ") << "the controller's own word counts";
}

TEST_F(MachineModelTest, APromptLastsAsLongAsTheControllerWaits) {
  hear("<Tool|MPos:0.000,0.000,0.000|FS:0,0>");
  hear("[MSG:Warning: Perform a probe with $TPW first!]");
  EXPECT_EQ(known().prompt, "Perform a probe with $TPW first!");
  EXPECT_EQ(known().messages.back().kind, vocabulary::FeedbackKind::Warning);
  hear("<Tool|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_FALSE(known().prompt.empty());
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_TRUE(known().prompt.empty());
}

TEST_F(MachineModelTest, InputsThatAreNotReportedAreNotKnown) {
  model_.speak(vocabulary::dialect_of(vocabulary::Firmware::GrblHal));
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_EQ(known().inputs, Inputs{});
  hear("$10=0");
  hear("<Idle|WPos:0.000,0.000,0.000>");
  EXPECT_FALSE(known().inputs);
}

TEST_F(MachineModelTest, AReportMaskThatCannotBeOneIsNone) {
  model_.speak(vocabulary::dialect_of(vocabulary::Firmware::GrblHal));
  hear("$10=0");
  hear("$10=" + std::string(85, '3'));
  hear("<Idle|MPos:0.000,0.000,0.000|FS:0,0>");
  EXPECT_FALSE(known().inputs);
}

TEST_F(MachineModelTest, KeepsTheLastMessages) {
  for (int number = 0; number < 30; ++number) hear("[MSG:number " + std::to_string(number) + "]");
  hear("[MSG:]");
  EXPECT_EQ(known().messages.size(), kMessagesKept);
  EXPECT_EQ(known().messages.back().text, "number 29");
}

TEST(Lexicon, TheControllersOwnWordsWin) {
  const auto& grbl = vocabulary::dialect_of(vocabulary::Firmware::Grbl);
  Lexicon lexicon;
  const auto ours = lexicon.error(grbl, 20);
  EXPECT_EQ(ours.source, FactSource::Inferred);
  EXPECT_FALSE(ours.title.empty());
  lexicon.learn(protocol::ErrorCodeRow{.id = 20, .title = "", .text = "Not supported. See the manual."});
  EXPECT_EQ(lexicon.error(grbl, 20).title, "Not supported");
  EXPECT_EQ(lexicon.error(grbl, 20).source, FactSource::Told);
  EXPECT_EQ(lexicon.error(grbl, 999).source, FactSource::Assumed);
  EXPECT_EQ(lexicon.alarms(grbl).size(), grbl.alarms.size());
  EXPECT_EQ(lexicon.errors(grbl).size(), 1U);
}

// The reference: what each field means, one at a time, in a map of texts. A field that a report leaves out keeps its
// value, but for those that are only printed while they are true.
class ReferenceFold {
 public:
  void report(const std::vector<std::pair<std::string, std::string>>& fields) {
    for (const auto* const fleeting : {"Ln", "DTG", "Pn"}) known_.erase(fleeting);
    others_.clear();
    std::set<std::string> seen;
    for (const auto& [name, value] : fields) {
      const bool is_known = kNames.contains(name) && seen.insert(name).second;
      if (!is_known) {
        others_.push_back({name, value});
      } else {
        known_[name] = value;
      }
    }
    if (seen.contains("Ov") && !seen.contains("A")) known_["A"] = "";
    place(seen.contains("MPos"), seen.contains("WPos"), seen.contains("WCO"));
  }

  [[nodiscard]] std::string text(const std::string& name) const {
    const auto found = known_.find(name);
    return found == known_.end() ? "" : found->second;
  }
  [[nodiscard]] std::optional<std::vector<double>> numbers(const std::string& name) const {
    const auto found = known_.find(name);
    if (found == known_.end()) return std::nullopt;
    std::vector<double> values;
    for (const auto part : base::split(found->second, ',')) values.push_back(*base::parse_decimal(part));
    return values;
  }
  [[nodiscard]] const std::optional<std::vector<double>>& machine() const { return machine_; }
  [[nodiscard]] const std::optional<std::vector<double>>& work() const { return work_; }
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& others() const { return others_; }

 private:
  using Place = std::optional<std::vector<double>>;

  /// What is printed counts; the other follows from the offset. An offset alone moves no axis.
  void place(bool tells_machine, bool tells_work, bool tells_offset) {
    const Place offset = numbers("WCO");
    const auto shifted = [&](const Place& from, double sign) -> Place {
      if (!from || !offset) return std::nullopt;
      Place to = from;
      for (std::size_t axis = 0; axis < to->size(); ++axis) (*to)[axis] += sign * (*offset)[axis];
      return to;
    };
    if (tells_machine) machine_ = numbers("MPos");
    if (tells_work) work_ = numbers("WPos");
    if (tells_machine && !tells_work) work_ = shifted(machine_, -1);
    if (tells_work && !tells_machine) machine_ = shifted(work_, 1);
    if (!tells_offset || tells_machine || tells_work) return;
    if (machine_) {
      work_ = shifted(machine_, -1);
    } else {
      machine_ = shifted(work_, 1);
    }
  }

  static inline const std::set<std::string> kNames{"MPos", "WPos", "WCO", "Bf", "Ln",  "DTG", "FS",  "Pn",
                                                   "Ov",   "A",    "T",   "H",  "WCS", "MPG", "TLR", "P"};
  std::map<std::string, std::string> known_;
  std::vector<std::pair<std::string, std::string>> others_;
  Place machine_;
  Place work_;
};

using Field = std::pair<std::string, std::string>;

std::string thousandths(int value) {
  return base::to_fixed(value / 1000.0, 3);
}

rc::Gen<std::string> position() {
  return rc::gen::map(rc::gen::container<std::vector<int>>(3, rc::gen::inRange(-400000, 400000)), [](const auto& axes) {
    return thousandths(axes[0]) + "," + thousandths(axes[1]) + "," + thousandths(axes[2]);
  });
}

rc::Gen<std::string> letters(const std::string& from) {
  return rc::gen::container<std::string>(rc::gen::elementOf(from));
}

rc::Gen<std::string> numbers(int count, int most) {
  return rc::gen::map(rc::gen::container<std::vector<int>>(static_cast<std::size_t>(count), rc::gen::inRange(0, most)),
                      [](const auto& values) {
                        std::string text;
                        for (const int value : values) text += (text.empty() ? "" : ",") + std::to_string(value);
                        return text;
                      });
}

rc::Gen<Field> named(std::string name, rc::Gen<std::string> value) {
  return rc::gen::map(std::move(value), [name](std::string text) { return Field{name, std::move(text)}; });
}

rc::Gen<Field> any_field() {
  return rc::gen::oneOf(named("MPos", position()), named("WPos", position()), named("WCO", position()),
                        named("DTG", position()), named("Bf", numbers(2, 1024)), named("Ln", numbers(1, 99999)),
                        named("FS", numbers(2, 24000)), named("Pn", letters("XYZABCUVWRHSDLTEOFMQP0123nk")),
                        named("Ov", numbers(3, 200)), named("A", letters("SCFMETxyz")), named("T", numbers(1, 99)),
                        named("H", numbers(1, 2)), named("WCS", rc::gen::element<std::string>("G54", "G59.3")),
                        named("MPG", numbers(1, 2)), named("TLR", numbers(1, 2)), named("P", numbers(1, 3)),
                        // Names that nobody knows, and known ones with values that they never have.
                        named("Qx", numbers(1, 9)), named("THC", letters("EAR")), named("SD2", numbers(2, 99)),
                        named("mpos", position()), named("Fan", numbers(1, 2)));
}

void check_positions(const Snapshot& known, const ReferenceFold& reference) {
  RC_ASSERT(known.work_offset_mm == reference.numbers("WCO"));
  RC_ASSERT(known.machine_position_mm == reference.machine());
  RC_ASSERT(known.work_position_mm == reference.work());
}

void check_fields(const Snapshot& known, const ReferenceFold& reference) {
  const auto number = [&](const std::string& name, std::size_t index) -> std::optional<double> {
    const auto values = reference.numbers(name);
    return values ? std::optional{(*values)[index]} : std::nullopt;
  };
  const auto same = [](const auto& optional, const std::optional<double>& expected) {
    return optional.has_value() == expected.has_value() && (!optional || static_cast<double>(*optional) == *expected);
  };
  RC_ASSERT(same(known.planner_blocks_free, number("Bf", 0)));
  RC_ASSERT(same(known.rx_bytes_free, number("Bf", 1)));
  RC_ASSERT(same(known.line_number, number("Ln", 0)));
  RC_ASSERT(same(known.feed_mm_per_min, number("FS", 0)));
  RC_ASSERT(same(known.spindle_rpm, number("FS", 1)));
  RC_ASSERT(same(known.tool, number("T", 0)));
  RC_ASSERT(same(known.tool_length.reference_set, number("TLR", 0)));
  RC_ASSERT(same(known.homing.all, number("H", 0)));
  RC_ASSERT(known.distance_to_go_mm == reference.numbers("DTG"));
  RC_ASSERT(known.pins == reference.text("Pn"));
  RC_ASSERT(known.pendant_in_control == (reference.text("MPG") == "1"));
  RC_ASSERT(known.work_coordinate_system.value_or("") == reference.text("WCS"));
  const auto overrides = reference.numbers("Ov");
  RC_ASSERT(known.overrides.has_value() == overrides.has_value());
  if (overrides) RC_ASSERT(known.overrides->feed == static_cast<int>((*overrides)[0]));
}

// Every letter is either a named input or kept: none is lost, none is made up.
void check_letters(const Snapshot& known, const ReferenceFold& reference) {
  RC_ASSERT(known.inputs.has_value());
  const std::string pins = reference.text("Pn");
  for (const char letter : pins) {
    const bool is_limit = std::string_view{"XYZABCUVW"}.contains(letter);
    const bool is_named = std::string_view{"RHSDLTEOFMQP"}.contains(letter);
    if (is_limit) RC_ASSERT(known.inputs->limits.contains(letter));
    if (!is_limit && !is_named) RC_ASSERT(known.inputs->other.contains(letter));
  }
  RC_ASSERT(known.inputs->probe == pins.contains('P'));
  RC_ASSERT(known.inputs->door == pins.contains('D'));
  RC_ASSERT(known.inputs->emergency_stop == pins.contains('E'));
  RC_ASSERT(known.inputs->single_block == pins.contains('Q'));
  if (!known.accessories) return;
  const std::string on = reference.text("A");
  RC_ASSERT(known.accessories->flood == on.contains('F'));
  RC_ASSERT(known.accessories->mist == on.contains('M'));
  RC_ASSERT(known.accessories->tool_change_pending == on.contains('T'));
  RC_ASSERT((known.accessories->spindle == SpindleTurn::Off) == (!on.contains('S') && !on.contains('C')));
}

// Any fields in any order and number, with unknown ones, unknown letters and doubles between them.
RC_GTEST_PROP(MachineModel, ReportsNeverChangeWhatIsKnownWrongly, ()) {
  MachineModel model = model_in_mm();
  ReferenceFold reference;
  const auto reports =
      *rc::gen::container<std::vector<std::vector<Field>>>(rc::gen::container<std::vector<Field>>(any_field()));
  std::uint64_t count = 0;
  for (const auto& fields : reports) {
    const std::string state = *rc::gen::element<std::string>("Idle", "Run", "Hold:0", "Jog", "Tool");
    std::string line = "<" + state;
    for (const auto& [name, value] : fields) line += "|" + name + ":" + value;
    model.fold(Instant{}, protocol::decode(line + ">"));
    reference.report(fields);
    const Snapshot& known = model.snapshot();
    RC_ASSERT(known.reports == ++count);
    RC_ASSERT(state.starts_with(vocabulary::name_of(known.state)));
    check_positions(known, reference);
    check_fields(known, reference);
    check_letters(known, reference);
    RC_ASSERT(known.other_fields.size() == reference.others().size());
    for (std::size_t at = 0; at < known.other_fields.size(); ++at) {
      RC_ASSERT(known.other_fields[at].name == reference.others()[at].first);
      RC_ASSERT(known.other_fields[at].value == reference.others()[at].second);
    }
  }
}

// Fields in any order, with unknown ones between them, give the same snapshot.
RC_GTEST_PROP(MachineModel, OrderAndUnknownFieldsChangeNothing, ()) {
  std::vector<std::string> fields{"MPos:1.000,2.000,3.000", "Bf:15,128",     "FS:500,8000", "Pn:XZ",
                                  "WCO:0.500,0.500,0.500",  "Ov:100,50,120", "A:SM",        "Ln:42"};
  const auto line_of = [](const std::vector<std::string>& parts) {
    std::string line = "<Run";
    for (const auto& part : parts) line += "|" + part;
    return line + ">";
  };
  MachineModel expected = model_in_mm();
  expected.fold(Instant{}, protocol::decode(line_of(fields)));
  std::mt19937 random{*rc::gen::arbitrary<unsigned>()};
  const auto strangers = *rc::gen::inRange(0, 5);
  for (int number = 0; number < strangers; ++number) {
    fields.push_back("Q" + std::to_string(number) + ":" + std::to_string(random() % 100));
  }
  std::ranges::shuffle(fields, random);
  MachineModel shuffled = model_in_mm();
  shuffled.fold(Instant{}, protocol::decode(line_of(fields)));
  auto snapshot = shuffled.snapshot();
  RC_ASSERT(snapshot.other_fields.size() == static_cast<std::size_t>(strangers));
  snapshot.other_fields.clear();
  RC_ASSERT(snapshot == expected.snapshot());
}

}  // namespace
}  // namespace kerf::machine
