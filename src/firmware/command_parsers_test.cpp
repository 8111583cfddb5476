#include <gtest/gtest.h>

#include "firmware/system_commands.hpp"

namespace kerf::firmware {
namespace {

using vocabulary::Firmware;

ErrorCode error_of(Firmware firmware, std::string_view line, MachineState state = MachineState::Idle) {
  const Personality& personality = personality_of(firmware);
  const auto parsed = personality.parse_command(personality, line, state, false);
  return parsed ? ErrorCode::Ok : parsed.error();
}

TEST(CommandParser, GrblOrderOfChecks) {
  EXPECT_EQ(error_of(Firmware::Grbl, "GX"), ErrorCode::InvalidStatement);
  EXPECT_EQ(error_of(Firmware::Grbl, "FOO"), ErrorCode::BadNumberFormat);
  EXPECT_EQ(error_of(Firmware::Grbl, "FOO", MachineState::Run), ErrorCode::IdleError);
  EXPECT_EQ(error_of(Firmware::Grbl, "110"), ErrorCode::InvalidStatement);
  EXPECT_EQ(error_of(Firmware::Grbl, "110=x"), ErrorCode::BadNumberFormat);
  EXPECT_EQ(error_of(Firmware::Grbl, "J"), ErrorCode::InvalidStatement);
  EXPECT_EQ(error_of(Firmware::Grbl, "J=X1", MachineState::Run), ErrorCode::IdleError);
  EXPECT_EQ(error_of(Firmware::Grbl, "I+"), ErrorCode::InvalidStatement);
  EXPECT_EQ(error_of(Firmware::Grbl, "N1=G20", MachineState::Alarm), ErrorCode::IdleError);
}

TEST(CommandParser, GrblHalIgnoresCaseAndBlanksInNames) {
  const Personality& personality = personality_of(Firmware::GrblHal);
  const auto parsed = personality.parse_command(personality, " 1 1 0 = 600", MachineState::Idle, false);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->command, Command::WriteSetting);
  EXPECT_EQ(parsed->key, "110");
  EXPECT_EQ(error_of(Firmware::GrblHal, "es"), ErrorCode::Ok);
  EXPECT_EQ(error_of(Firmware::GrblHal, "ES=1"), ErrorCode::InvalidStatement);
  EXPECT_EQ(error_of(Firmware::GrblHal, "-1=3"), ErrorCode::InvalidStatement);
  EXPECT_EQ(error_of(Firmware::GrblHal, "10", MachineState::Run), ErrorCode::IdleError);
  EXPECT_EQ(error_of(Firmware::GrblHal, "RST"), ErrorCode::InvalidStatement);
  EXPECT_EQ(error_of(Firmware::GrblHal, "X=1"), ErrorCode::Ok);
  EXPECT_EQ(error_of(Firmware::GrblHal, "HA", MachineState::Run), ErrorCode::IdleError);
  EXPECT_EQ(error_of(Firmware::GrblHal, std::string(40, '1')), ErrorCode::InvalidStatement);
  EXPECT_EQ(personality.parse_command(personality, "4294967396", MachineState::Idle, false)->key, "0");
}

TEST(CommandParser, GrblHalBlocksInCriticalAlarm) {
  const Personality& personality = personality_of(Firmware::GrblHal);
  EXPECT_EQ(personality.parse_command(personality, "X", MachineState::Alarm, true).error(),
            ErrorCode::NotAllowedInCriticalEvent);
  EXPECT_TRUE(personality.parse_command(personality, "I", MachineState::Alarm, true));
}

TEST(CommandParser, RabbitKnowsNamesAndNumbers) {
  const Personality& personality = personality_of(Firmware::Rabbit);
  const auto named = personality.parse_command(personality, "$Homing/Enable = 1", MachineState::Idle, false);
  ASSERT_TRUE(named);
  EXPECT_EQ(named->key, "Homing/Enable");
  EXPECT_EQ(named->value, " 1");
  EXPECT_EQ(personality.parse_command(personality, "$110", MachineState::Idle, false)->command, Command::ReadSetting);
  EXPECT_EQ(personality.parse_command(personality, "$gcode/modes=1", MachineState::Run, false)->command,
            Command::ParserState);
}

TEST(CommandParser, RabbitTakesBrackets) {
  const Personality& personality = personality_of(Firmware::Rabbit);
  const auto parse = [&](std::string_view line) {
    return personality.parse_command(personality, line, MachineState::Idle, false);
  };
  EXPECT_EQ(parse("[X/MaxRate]500"),
            (ParsedCommand{.command = Command::WriteSetting, .key = "X/MaxRate", .value = "500", .has_value = true}));
  EXPECT_EQ(parse("[X/MaxRate]")->command, Command::ReadSetting);
  EXPECT_EQ(parse("[J]G91X1F100")->command, Command::Jog);
  EXPECT_EQ(parse("[X").error(), ErrorCode::InvalidStatement);
  EXPECT_EQ(parse("$X Y")->command, Command::Unlock);
}

}  // namespace
}  // namespace kerf::firmware
