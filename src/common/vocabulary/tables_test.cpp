// The tables agree with themselves: unique keys, sorted rows, nothing empty that must not be.

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "common/vocabulary/accessories.hpp"
#include "common/vocabulary/alarms.hpp"
#include "common/vocabulary/dialect.hpp"
#include "common/vocabulary/errors.hpp"
#include "common/vocabulary/machine_state.hpp"
#include "common/vocabulary/messages.hpp"
#include "common/vocabulary/options.hpp"
#include "common/vocabulary/pins.hpp"
#include "common/vocabulary/realtime.hpp"
#include "common/vocabulary/report_mask.hpp"
#include "common/vocabulary/status_fields.hpp"

namespace kerf::vocabulary {
namespace {

constexpr std::array kFirmwares{Firmware::Grbl, Firmware::Rabbit, Firmware::GrblHal};

// Our texts are printed between | and ] in enumerations and between " in CSV lists.
bool is_printable_in_rows(std::string_view text) {
  return text.find_first_of("|]\"\r\n") == std::string_view::npos &&
         std::ranges::all_of(text, [](char letter) { return letter >= ' ' && letter <= '~'; });
}

template <typename Rows, typename Key>
void expect_unique(const Rows& rows, Key key) {
  std::set<decltype(key(*rows.begin()))> seen;
  for (const auto& row : rows) EXPECT_TRUE(seen.insert(key(row)).second) << testing::PrintToString(key(row));
}

void expect_good_codes(std::span<const CodeRow> rows) {
  EXPECT_TRUE(std::ranges::is_sorted(rows, {}, &CodeRow::code));
  expect_unique(rows, [](const CodeRow& row) { return row.code; });
  for (const CodeRow& row : rows) {
    EXPECT_FALSE(row.title.empty()) << row.code;
    EXPECT_FALSE(row.title.ends_with('.')) << row.title;
    EXPECT_TRUE(is_printable_in_rows(row.title)) << row.title;
    EXPECT_TRUE(is_printable_in_rows(row.text)) << row.text;
    if (row.code != 0) {
      EXPECT_TRUE(row.text.ends_with('.')) << row.text;
    }
    EXPECT_EQ(find_code(rows, row.code), &row);
  }
}

TEST(Tables, ErrorCodesAreUniqueInEachFirmware) {
  for (const Firmware firmware : kFirmwares) expect_good_codes(error_rows(firmware));
}

TEST(Tables, AlarmCodesAreUniqueInEachFirmware) {
  for (const Firmware firmware : kFirmwares) {
    expect_good_codes(alarm_rows(firmware));
    EXPECT_EQ(alarm_rows(firmware).front().code, 1);
  }
}

TEST(Tables, EveryCodeOfTheUnionBelongsToSomebody) {
  for (const CodeRow& row : error_rows()) EXPECT_NE(row.known_to, FirmwareSet::None) << row.code;
  for (const CodeRow& row : alarm_rows()) EXPECT_NE(row.known_to, FirmwareSet::None) << row.code;
  EXPECT_TRUE(std::ranges::is_sorted(error_rows(), {}, &CodeRow::code));
  EXPECT_TRUE(std::ranges::is_sorted(alarm_rows(), {}, &CodeRow::code));
}

TEST(Tables, UnknownCodesAreNotFound) {
  EXPECT_EQ(find_code(error_rows(Firmware::Grbl), 39), nullptr);
  EXPECT_EQ(find_code(error_rows(Firmware::GrblHal), 59), nullptr);
  EXPECT_EQ(find_code(error_rows(Firmware::GrblHal), 1000), nullptr);
  EXPECT_EQ(find_code(alarm_rows(Firmware::Grbl), -1), nullptr);
}

TEST(Tables, RealtimeBytesAreUniqueAndSorted) {
  EXPECT_TRUE(std::ranges::is_sorted(realtime_rows(), {}, &RealtimeRow::byte));
  expect_unique(realtime_rows(), [](const RealtimeRow& row) { return row.byte; });
  for (const RealtimeRow& row : realtime_rows()) {
    EXPECT_FALSE(row.name.empty());
    EXPECT_TRUE(row.text.ends_with('.')) << row.text;
    EXPECT_EQ(find_realtime(static_cast<std::uint8_t>(row.byte)), &row);
    if (row.alternate_of) {
      EXPECT_NE(find_realtime(static_cast<std::uint8_t>(*row.alternate_of)), nullptr);
    }
  }
  EXPECT_EQ(find_realtime('G'), nullptr);
  EXPECT_EQ(find_realtime(0xFF), nullptr);
}

TEST(Tables, EveryRealtimeByteThatActsIsTakenOutOfLines) {
  for (const Dialect* dialect : all_dialects()) {
    for (const RealtimeRow& row : realtime_rows()) {
      if (!contains(row.known_to, dialect->firmware) || row.byte == Realtime::Reboot) continue;
      EXPECT_TRUE(is_realtime(*dialect, static_cast<std::uint8_t>(row.byte))) << dialect->name << row.name;
    }
    for (const char letter : std::string_view{"\r\nG0X1.$/%()[];"}) {
      EXPECT_FALSE(is_realtime(*dialect, static_cast<std::uint8_t>(letter))) << dialect->name << letter;
    }
  }
}

TEST(Tables, StatesReadBack) {
  for (const MachineStateRow& row : machine_state_rows()) {
    EXPECT_EQ(name_of(row.state), row.name);
    EXPECT_EQ(machine_state_of(row.name), row.state);
  }
  EXPECT_EQ(machine_state_rows().size(), static_cast<std::size_t>(MachineState::Tool));
  EXPECT_EQ(machine_state_of("Unknown"), std::nullopt);
  EXPECT_EQ(machine_state_of("idle"), std::nullopt);
  EXPECT_EQ(name_of(MachineState::Unknown), "Unknown");
}

TEST(Tables, SubstatesDependOnTheFirmware) {
  ASSERT_NE(find_substate(Firmware::Grbl, MachineState::Door, 3), nullptr);
  EXPECT_EQ(find_substate(Firmware::Grbl, MachineState::Door, 3)->title, "resuming");
  EXPECT_EQ(find_substate(Firmware::GrblHal, MachineState::Door, 3), nullptr);
  ASSERT_NE(find_substate(Firmware::GrblHal, MachineState::Door, 4), nullptr);
  EXPECT_EQ(find_substate(Firmware::Grbl, MachineState::Run, 2), nullptr);
  EXPECT_NE(find_substate(Firmware::Unknown, MachineState::Run, 2), nullptr);
}

TEST(Tables, FieldsStandAtTheirEnumerator) {
  for (const StatusFieldRow& row : status_field_rows()) EXPECT_EQ(&row_of(row.field), &row);
  EXPECT_EQ(grblhal_field_order().size(), status_field_rows().size());
  expect_unique(grblhal_field_order(), [](StatusField field) { return field; });
  expect_unique(grbl_field_order(), [](StatusField field) { return field; });
  for (const StatusField field : grbl_field_order()) {
    EXPECT_TRUE(contains(row_of(field).known_to, Firmware::Grbl)) << row_of(field).name;
  }
}

TEST(Tables, ReportBitsStandAtTheirNumber) {
  unsigned number = 0;
  for (const ReportBitRow& row : report_bit_rows()) EXPECT_EQ(static_cast<unsigned>(row.bit), number++);
  EXPECT_EQ(number, 14U);
}

TEST(Tables, LettersHaveOneSenseInEachFirmware) {
  for (const Firmware firmware : kFirmwares) {
    std::set<char> pins;
    std::set<char> accessories;
    std::set<char> options;
    for (const PinRow& row : pin_rows()) {
      if (contains(row.known_to, firmware)) {
        EXPECT_TRUE(pins.insert(row.letter).second) << row.letter;
      }
    }
    for (const AccessoryRow& row : accessory_rows()) {
      if (contains(row.known_to, firmware)) {
        EXPECT_TRUE(accessories.insert(row.letter).second) << row.letter;
      }
    }
    for (const OptionRow& row : option_rows()) {
      if (contains(row.known_to, firmware)) {
        EXPECT_TRUE(options.insert(row.letter).second) << row.letter;
      }
    }
  }
}

TEST(Tables, BracketsAndTokensAreUnique) {
  expect_unique(bracket_rows(), [](const BracketRow& row) { return row.name; });
  expect_unique(new_option_rows(), [](const NewOptionRow& row) { return row.token; });
  EXPECT_EQ(find_bracket("nonsense"), nullptr);
  ASSERT_NE(find_bracket("PRB"), nullptr);
  EXPECT_EQ(find_bracket("PRB")->syntax, "x,y,z:0|1");
}

TEST(Tables, FeedbackStandsAtItsEnumeratorAndReadsBack) {
  std::size_t index = 0;
  for (const FeedbackRow& row : feedback_rows()) {
    EXPECT_EQ(static_cast<std::size_t>(row.id), index++);
    for (const Firmware firmware : kFirmwares) {
      const std::string_view text = feedback_text(firmware, row.id);
      if (!text.empty()) {
        EXPECT_EQ(feedback_of(text), row.id) << text;
      }
    }
  }
}

TEST(Tables, DialectsAreComplete) {
  for (const Dialect* dialect : all_dialects()) {
    EXPECT_EQ(&dialect_of(dialect->firmware), dialect);
    EXPECT_EQ(find_dialect(dialect->key), dialect);
    EXPECT_EQ(dialect->name, name_of(dialect->firmware));
    EXPECT_TRUE(dialect->welcome.starts_with(dialect->welcome_start)) << dialect->name;
    EXPECT_FALSE(dialect->version.empty());
    EXPECT_EQ(dialect->build.size(), 8U);
    EXPECT_GT(dialect->rx_bytes.usable, 0);
    EXPECT_GT(dialect->planner_blocks.usable, 0);
    EXPECT_GT(dialect->line_length, 0);
    EXPECT_GT(dialect->stored_line_length, 0);
    EXPECT_LE(dialect->axes_default, dialect->axes_max);
    EXPECT_GT(dialect->override_refresh.busy, 0);
    EXPECT_GT(dialect->work_offset_refresh.idle, 0);
    EXPECT_LE(dialect->report_mask_default, dialect->report_mask_max);
    EXPECT_GT(dialect->alarm_delay.count(), 0);
    EXPECT_EQ(dialect->errors.size(), error_rows(dialect->firmware).size());
    EXPECT_EQ(dialect->alarms.size(), alarm_rows(dialect->firmware).size());
    EXPECT_EQ(dialect->settings.size(), setting_rows(dialect->firmware).size());
    EXPECT_FALSE(dialect->field_order.empty());
    for (const char letter : dialect->options) EXPECT_NE(find_option(dialect->firmware, letter), nullptr) << letter;
  }
  EXPECT_EQ(find_dialect("marlin"), nullptr);
  EXPECT_EQ(find_dialect("GrblHAL"), &dialect_of(Firmware::GrblHal));
}

TEST(Tables, AnUnknownFirmwareIsSpokenToCautiously) {
  const Dialect& unknown = dialect_of(Firmware::Unknown);
  EXPECT_EQ(unknown.firmware, Firmware::Unknown);
  for (const Dialect* dialect : all_dialects()) {
    EXPECT_LE(unknown.rx_bytes.usable, dialect->rx_bytes.usable);
    EXPECT_LE(unknown.planner_blocks.usable, dialect->planner_blocks.usable);
    EXPECT_LE(unknown.line_length, dialect->line_length);
    EXPECT_LE(unknown.axes_max, dialect->axes_max);
  }
  EXPECT_FALSE(unknown.answers_full_status);
  EXPECT_FALSE(unknown.can_enumerate_codes);
}

}  // namespace
}  // namespace kerf::vocabulary
