// Spot checks of the tables against what was read in firmware source and seen on the wire (protocol.md).

#include <algorithm>

#include <gtest/gtest.h>

#include "common/vocabulary/accessories.hpp"
#include "common/vocabulary/alarms.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/errors.hpp"
#include "common/vocabulary/messages.hpp"
#include "common/vocabulary/options.hpp"
#include "common/vocabulary/pins.hpp"
#include "common/vocabulary/report_mask.hpp"

namespace kerf::vocabulary {
namespace {

const Dialect& grbl() {
  return dialect_of(Firmware::Grbl);
}
const Dialect& rabbit() {
  return dialect_of(Firmware::Rabbit);
}
const Dialect& grblhal() {
  return dialect_of(Firmware::GrblHal);
}

int count_listed(std::span<const CodeRow> rows) {
  return static_cast<int>(std::ranges::count(rows, BuildOption::Usual, &CodeRow::build));
}

// protocol.md 1.1
TEST(Facts, Welcomes) {
  EXPECT_EQ(grbl().welcome, "Grbl 1.1h ['$' for help]");
  EXPECT_EQ(rabbit().welcome, "Rabbit GRBL v1.6.0 Build 20260315  ");
  EXPECT_EQ(grblhal().welcome, "GrblHAL 1.1f ['$' or '$HELP' for help]");
}

// protocol.md 6.1
TEST(Facts, Buffers) {
  EXPECT_EQ(grbl().rx_bytes.usable, 128);
  EXPECT_EQ(rabbit().rx_bytes.usable, 255);
  EXPECT_EQ(grblhal().rx_bytes.usable, 1023);
  EXPECT_EQ(grblhal().rx_bytes.printed, 1024);
  EXPECT_EQ(grbl().planner_blocks.usable, 15);
  EXPECT_EQ(grblhal().planner_blocks.usable, 100);
  EXPECT_EQ(grbl().line_length, 79);
  EXPECT_EQ(rabbit().line_length, 255);
  EXPECT_EQ(grblhal().line_length, 256);
}

// protocol.md 6.2, 6.4
TEST(Facts, LineEndsAndLatch) {
  EXPECT_EQ(grbl().line_ending, LineEnding::EachTerminatorAnswers);
  EXPECT_EQ(rabbit().line_ending, LineEnding::CrLfIsOne);
  EXPECT_EQ(grblhal().line_ending, LineEnding::PairedEitherWay);
  EXPECT_FALSE(grbl().error_latch);
  EXPECT_FALSE(rabbit().error_latch);
  EXPECT_TRUE(grblhal().error_latch);
}

// protocol.md 2
TEST(Facts, RealtimeBytes) {
  EXPECT_TRUE(acts_on(Firmware::Rabbit, Realtime::RapidOverrideExtraLow));
  EXPECT_FALSE(acts_on(Firmware::Grbl, Realtime::RapidOverrideExtraLow));
  EXPECT_FALSE(acts_on(Firmware::GrblHal, Realtime::RapidOverrideExtraLow));
  EXPECT_TRUE(acts_on(Firmware::GrblHal, Realtime::FullStatus));
  EXPECT_FALSE(acts_on(Firmware::Grbl, Realtime::FullStatus));
  EXPECT_FALSE(acts_on(Firmware::Rabbit, Realtime::StatusQueryAlternate));
  for (const Realtime byte : {Realtime::SoftReset, Realtime::FeedHold, Realtime::StatusQuery, Realtime::CycleStart,
                              Realtime::SafetyDoor, Realtime::JogCancel, Realtime::FeedOverrideReset}) {
    EXPECT_EQ(find_realtime(static_cast<std::uint8_t>(byte))->known_to, FirmwareSet::All);
  }
  EXPECT_TRUE(is_realtime(grbl(), 0x87));  // dropped there, but never part of a line
  EXPECT_FALSE(is_realtime(grbl(), 0x05));
  EXPECT_TRUE(is_realtime(grblhal(), 0x05));
  EXPECT_TRUE(is_realtime(grblhal(), 0x19));
  EXPECT_FALSE(is_realtime(grblhal(), 0x08));  // backspace edits the line
}

// protocol.md 8
TEST(Facts, ClashingErrors) {
  EXPECT_EQ(find_code(rabbit().errors, 18)->title, "No homing cycle defined");
  EXPECT_EQ(find_code(grblhal().errors, 18)->title, "Reset input is active");
  EXPECT_EQ(find_code(grbl().errors, 18), nullptr);
  EXPECT_NE(find_code(rabbit().errors, 39)->title, find_code(grblhal().errors, 39)->title);
  EXPECT_NE(find_code(rabbit().errors, 80)->title, find_code(grblhal().errors, 80)->title);
  EXPECT_NE(find_code(rabbit().errors, 81)->title, find_code(grblhal().errors, 81)->title);
  EXPECT_NE(find_code(rabbit().errors, 100), nullptr);
  EXPECT_EQ(find_code(grblhal().errors, 100), nullptr);
  EXPECT_EQ(grbl().errors.back().code, 38);
  EXPECT_EQ(grblhal().errors.back().code, 253);
}

// Transcript 08: $EE of the reference build has 68 rows, 0 among them.
TEST(Facts, ListedErrors) {
  EXPECT_EQ(count_listed(grblhal().errors), 67);
  EXPECT_EQ(find_code(grblhal().errors, 75)->build, BuildOption::Expressions);
  EXPECT_EQ(find_code(grblhal().errors, 64)->build, BuildOption::FileSystem);
}

// protocol.md 8, transcript 07
TEST(Facts, Alarms) {
  EXPECT_EQ(grbl().alarms.size(), 10U);
  EXPECT_EQ(rabbit().alarms.size(), 10U);
  EXPECT_EQ(grblhal().alarms.size(), 22U);
  EXPECT_TRUE(find_code(grbl().alarms, 1)->critical);
  EXPECT_TRUE(find_code(grbl().alarms, 2)->critical);
  EXPECT_FALSE(find_code(grbl().alarms, 3)->critical);
  EXPECT_FALSE(find_code(grbl().alarms, 10)->critical);
  EXPECT_TRUE(find_code(grblhal().alarms, 10)->critical);
  EXPECT_TRUE(find_code(grblhal().alarms, 17)->critical);
  EXPECT_TRUE(find_code(grblhal().alarms, 20)->critical);
  EXPECT_EQ(find_code(grblhal().alarms, 10)->title, "E-stop");
}

// protocol.md 3.4, 3.5
TEST(Facts, Reports) {
  EXPECT_EQ(grblhal().report_mask_default, 511U);
  EXPECT_EQ(grblhal().report_mask_max, 16383U);
  EXPECT_EQ(grbl().report_mask_default, 1U);
  EXPECT_EQ(grblhal().override_refresh.busy, 20);
  EXPECT_EQ(grblhal().work_offset_refresh.busy, 30);
  EXPECT_EQ(rabbit().work_offset_refresh.busy, 10);
  EXPECT_EQ(mask_of(ReportBit::DistanceToGo), 8192U);
  EXPECT_TRUE(has(511, ReportBit::SyncOnWorkOffsetChange));
  EXPECT_FALSE(has(511, ReportBit::ParserState));
}

// protocol.md 3.3, 4.5, 4.6
TEST(Facts, Letters) {
  EXPECT_EQ(find_pin(Firmware::GrblHal, 'T')->name, "optional stop off");
  EXPECT_EQ(find_pin(Firmware::Grbl, 'T'), nullptr);
  EXPECT_NE(find_pin(Firmware::Rabbit, '3'), nullptr);
  EXPECT_EQ(find_accessory(Firmware::Grbl, 'T'), nullptr);
  EXPECT_NE(find_accessory(Firmware::GrblHal, 'T'), nullptr);
  EXPECT_EQ(find_option(Firmware::Rabbit, 'L')->name, "two switches an axis");
  EXPECT_EQ(find_option(Firmware::Grbl, 'L')->name, "no lock at power-up");
  EXPECT_EQ(find_option(Firmware::GrblHal, '2')->name, "ganged axes");
  EXPECT_EQ(find_option(Firmware::GrblHal, 'E'), nullptr);
  EXPECT_EQ(find_new_option("ATC=1")->token, "ATC");
  EXPECT_EQ(find_new_option("RT+")->token, "RT+");
  EXPECT_EQ(find_new_option("NEW"), nullptr);
}

// protocol.md 4.7
TEST(Facts, FeedbackTexts) {
  EXPECT_EQ(feedback_text(Firmware::Rabbit, FeedbackText::ProgramEnd), "Program End");
  EXPECT_EQ(feedback_text(Firmware::Grbl, FeedbackText::CheckLimits), "Check Limits");
  EXPECT_EQ(feedback_text(Firmware::Rabbit, FeedbackText::Enabled), "");
  EXPECT_EQ(feedback_of("pgm end"), FeedbackText::ProgramEnd);
  EXPECT_EQ(feedback_of("Warning: Perform a probe with $TPW first!"), FeedbackText::ProbeToolFirst);
  EXPECT_EQ(feedback_of("Reset during streaming of file at line: 12"), FeedbackText::ResetDuringFile);
  EXPECT_EQ(feedback_of(""), std::nullopt);
  EXPECT_EQ(feedback_of("hello"), std::nullopt);
  EXPECT_EQ(feedback_kind("Info: Job terminated due to connection change"), FeedbackKind::Info);
  EXPECT_EQ(feedback_kind("Information"), FeedbackKind::Plain);
  EXPECT_EQ(without_kind("Error: x"), "x");
}

}  // namespace
}  // namespace kerf::vocabulary
