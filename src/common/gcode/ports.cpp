// M62 to M68 of grblHAL: user outputs, and waiting for a user input. Which ports there are is the machine's affair.

#include "common/gcode/acts.hpp"
#include "common/gcode/checks.hpp"

namespace kerf::gcode {

namespace {

constexpr std::uint8_t kWaitModes = 5;

bool is_output(PortWord word) {
  return word != PortWord::None && word != PortWord::Wait;
}

ErrorCode check_digital_output(Block& block, const PortCounts& ports) {
  if (!block.words.has('P')) return ErrorCode::ValueWordMissing;
  if (block.p < 0.0F) return ErrorCode::NegativeValue;
  if (block.p >= static_cast<float>(ports.digital_outputs)) return ErrorCode::ValueOutOfRange;
  block.words.take('P');
  return ErrorCode::Ok;
}

ErrorCode check_analog_output(Block& block, const PortCounts& ports) {
  if (!block.words.has_any("EQ")) return ErrorCode::ValueWordMissing;
  if (block.e >= ports.analog_outputs) return ErrorCode::SpindleSpeedOutOfRange;
  block.words.take_all("EQ");
  return ErrorCode::Ok;
}

ErrorCode check_wait(Block& block, const PortCounts& ports) {
  if (!block.words.has_any("LQ")) return ErrorCode::ValueWordMissing;
  if (block.words.has('P') && block.words.has('E')) return ErrorCode::ValueWordConflict;
  if (block.l >= kWaitModes || (block.l != 0 && block.q == 0.0F)) return ErrorCode::ValueOutOfRange;
  if (block.words.has('P')) {
    if (block.p < 0.0F) return ErrorCode::NegativeValue;
    if (block.p >= static_cast<float>(ports.digital_inputs)) return ErrorCode::ValueOutOfRange;
  }
  if (block.words.has('E') && (block.e >= ports.analog_inputs || block.l != 0)) return ErrorCode::ValueOutOfRange;
  block.port_is_analog = block.words.has('E');
  block.words.take_all("ELPQ");
  return ErrorCode::Ok;
}

}  // namespace

bool has_port_for(PortWord word, const PortCounts& ports) {
  switch (word) {
    case PortWord::None: return true;
    case PortWord::Wait: return ports.digital_inputs + ports.analog_inputs > 0;
    case PortWord::AnalogWithMotion:
    case PortWord::Analog: return ports.analog_outputs > 0;
    default: return ports.digital_outputs > 0;
  }
}

ErrorCode check_ports(Block& block, BlockContext& context) {
  const PortCounts& ports = context.settings.ports;
  switch (block.port_word) {
    case PortWord::None: return ErrorCode::Ok;
    case PortWord::Wait: return check_wait(block, ports);
    case PortWord::AnalogWithMotion:
    case PortWord::Analog: return check_analog_output(block, ports);
    default: return check_digital_output(block, ports);
  }
}

ErrorCode act_ports(Block& block, BlockContext& context) {
  const PortWord word = block.port_word;
  if (word == PortWord::Wait) {
    context.out.push_back(PortWait{.digital = !block.port_is_analog,
                                   .port = block.port_is_analog ? block.e : static_cast<std::uint8_t>(block.p),
                                   .mode = static_cast<WaitMode>(block.l),
                                   .timeout_s = block.q});
  } else if (is_output(word)) {
    const bool analog = word == PortWord::Analog || word == PortWord::AnalogWithMotion;
    const bool on = word == PortWord::On || word == PortWord::OnWithMotion;
    context.out.push_back(PortOutput{.digital = !analog,
                                     .with_motion = word == PortWord::OnWithMotion || word == PortWord::OffWithMotion ||
                                                    word == PortWord::AnalogWithMotion,
                                     .port = analog ? block.e : static_cast<std::uint8_t>(block.p),
                                     .value = analog ? block.q : (on ? 1.0F : 0.0F)});
  }
  return ErrorCode::Ok;
}

}  // namespace kerf::gcode
