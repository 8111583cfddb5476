#include "firmware/board_facts.hpp"

#include <string>

#include "common/gcode/numbers.hpp"
#include "common/gcode/print_number.hpp"
#include "firmware/board.hpp"

namespace kerf::firmware {

using gcode::SettingNumber;
using vocabulary::SettingType;

namespace {

SettingNumber::Kind kind_of(SettingType type) {
  switch (type) {
    case SettingType::Decimal: return SettingNumber::Kind::Decimal;
    case SettingType::Integer:
    case SettingType::Bitfield:
    case SettingType::ExclusiveBitfield:
    case SettingType::Radio: return SettingNumber::Kind::Whole;
    default: return SettingNumber::Kind::NotNumber;
  }
}

}  // namespace

AxisValues BoardFacts::position_mm() const {
  return board_.position_mm();
}

AxisMask BoardFacts::homed_axes() const {
  return board_.homed;
}

bool BoardFacts::is_homed() const {
  const AxisMask cycles = board_.homing_axes();
  const bool by_hand = board_.settings.flag(setting::kHoming, homing_bit::kSingleAxis) ||
                       board_.settings.flag(setting::kHoming, homing_bit::kManual);
  if (cycles == 0 && !by_hand) return false;
  const AxisMask wanted = cycles != 0 ? cycles : board_.all_axes();
  return (wanted & board_.homed) == wanted;
}

// grblHAL core system.h, the STATE_ bits.
int BoardFacts::state_number() const {
  switch (board_.state) {
    case MachineState::Alarm: return 1;
    case MachineState::Check: return 2;
    case MachineState::Home: return 3;
    case MachineState::Run: return 4;
    case MachineState::Hold: return 5;
    case MachineState::Jog: return 6;
    case MachineState::Door: return 7;
    case MachineState::Sleep: return 8;
    case MachineState::Tool: return 10;
    default: return 0;
  }
}

std::optional<SettingNumber> BoardFacts::setting(int id) const {
  const auto* slot = board_.settings.find(std::to_string(id));
  if (slot == nullptr) return std::nullopt;
  return SettingNumber{.kind = kind_of(slot->match.row->type), .value = static_cast<float>(slot->number)};
}

vocabulary::ErrorCode BoardFacts::write_setting(int id, float value) {
  constexpr int kDecimals = 6;
  const auto found = setting(id);
  std::string text;
  if (found && found->kind == SettingNumber::Kind::Decimal) {
    gcode::append_number(gcode::NumberPrinter::RoundThenSplit, value, kDecimals, text);
  } else {
    text = std::to_string(gcode::to_uint32(value));
  }
  if (const auto written = board_.settings.write(std::to_string(id), text); !written) return written.error();
  board_.apply_settings();
  board_.store_settings();
  return vocabulary::ErrorCode::Ok;
}

}  // namespace kerf::firmware
