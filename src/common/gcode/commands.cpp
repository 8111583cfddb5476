#include "common/gcode/commands.hpp"

namespace kerf::gcode {

namespace {

template <typename Enum>
constexpr std::uint8_t code(Enum value) {
  return static_cast<std::uint8_t>(value);
}

constexpr CommandRow word(std::uint16_t number, Group group, Meaning meaning, std::uint8_t argument = 0) {
  return {.number = number, .group = group, .meaning = meaning, .argument = argument};
}

constexpr CommandRow with_fraction(CommandRow row, std::uint8_t hundredths) {
  row.hundredths = hundredths;
  return row;
}

constexpr CommandRow else_unsupported(CommandRow row) {
  row.bad_fraction = ErrorCode::UnsupportedCommand;
  return row;
}

constexpr CommandRow claiming(CommandRow row, AxisCommand as, Claim claim = Claim::IfFree) {
  row.claim = claim;
  row.claims_as = as;
  return row;
}

constexpr CommandRow claims_first(CommandRow row) {
  row.claims_before_fraction = true;
  return row;
}

constexpr CommandRow any_fraction(CommandRow row) {
  row.bad_fraction = ErrorCode::Ok;
  return row;
}

constexpr CommandRow motion(std::uint16_t number, MotionMode mode, Claim claim = Claim::IfFree) {
  return claims_first(claiming(word(number, Group::G1, Meaning::Motion, code(mode)), AxisCommand::Motion, claim));
}

/// Grbl and Rabbit look for the axis claim before they refuse a strange G38; grblHAL the other way round.
constexpr CommandRow probe(std::uint8_t hundredths, MotionMode mode, bool claim_is_first) {
  CommandRow row = else_unsupported(with_fraction(motion(38, mode), hundredths));
  row.claims_before_fraction = claim_is_first;
  return row;
}

constexpr CommandRow non_modal(std::uint16_t number, NonModal what) {
  return word(number, Group::G0, Meaning::NonModal, code(what));
}

/// G28, G30 and G92 with their fractions; the plain form uses the axis words.
constexpr CommandRow stored(std::uint16_t number, std::uint8_t hundredths, NonModal what) {
  const CommandRow row = else_unsupported(with_fraction(non_modal(number, what), hundredths));
  return hundredths == 0 ? claiming(row, AxisCommand::NonModal) : row;
}

constexpr CommandRow tool_length(std::uint16_t number, std::uint8_t hundredths, ToolLengthMode mode) {
  return with_fraction(word(number, Group::G8, Meaning::ToolLength, code(mode)), hundredths);
}

constexpr CommandRow offset(std::uint16_t number, std::uint8_t index, std::uint8_t hundredths = 0) {
  return with_fraction(word(number, Group::G12, Meaning::WorkOffset, index), hundredths);
}

constexpr CommandRow coolant(std::uint16_t number, CoolantWord what) {
  return word(number, Group::M8, Meaning::Coolant, code(what));
}

constexpr CommandRow flow(std::uint16_t number, ProgramFlow what) {
  return word(number, Group::M4, Meaning::ProgramFlow, code(what));
}

constexpr CommandRow spindle(std::uint16_t number, SpindleDirection direction) {
  return word(number, Group::M7, Meaning::Spindle, code(direction));
}

constexpr CommandRow overrides(std::uint16_t number, OverrideWord what) {
  return word(number, Group::M9, Meaning::Override, code(what));
}

constexpr CommandRow pin(std::uint16_t number, PinWord what) {
  return word(number, Group::M10, Meaning::Pin, code(what));
}

constexpr CommandRow port(std::uint16_t number, PortWord what) {
  return word(number, Group::M10, Meaning::Port, code(what));
}

constexpr CommandRow saved_state(std::uint16_t number, SavedState what) {
  return word(number, Group::None, Meaning::SavedState, code(what));
}

constexpr CommandRow macro(std::uint16_t number, std::uint8_t hundredths, MacroCall what) {
  return else_unsupported(with_fraction(word(number, Group::G16, Meaning::Macro, code(what)), hundredths));
}

constexpr CommandRow kG4 = non_modal(4, NonModal::Dwell);
constexpr CommandRow kG10 = claiming(non_modal(10, NonModal::SetData), AxisCommand::NonModal);
constexpr CommandRow kG17 = word(17, Group::G2, Meaning::Plane, code(Plane::XY));
constexpr CommandRow kG18 = word(18, Group::G2, Meaning::Plane, code(Plane::ZX));
constexpr CommandRow kG19 = word(19, Group::G2, Meaning::Plane, code(Plane::YZ));
constexpr CommandRow kG20 = word(20, Group::G6, Meaning::Units, 1);
constexpr CommandRow kG21 = word(21, Group::G6, Meaning::Units, 0);
constexpr CommandRow kG28 = stored(28, 0, NonModal::GoHome28);
constexpr CommandRow kG28Point1 = stored(28, 10, NonModal::SetHome28);
constexpr CommandRow kG30 = stored(30, 0, NonModal::GoHome30);
constexpr CommandRow kG30Point1 = stored(30, 10, NonModal::SetHome30);
constexpr CommandRow kG40 = word(40, Group::G7, Meaning::Nothing);
constexpr CommandRow kG53 = non_modal(53, NonModal::AbsoluteOverride);
constexpr CommandRow kG61 = else_unsupported(word(61, Group::G13, Meaning::Nothing));
constexpr CommandRow kG80 = word(80, Group::G1, Meaning::Motion, code(MotionMode::None));
constexpr CommandRow kG90 = else_unsupported(word(90, Group::G3, Meaning::Distance, 0));
constexpr CommandRow kG91 = else_unsupported(word(91, Group::G3, Meaning::Distance, 1));
constexpr CommandRow kG91Point1 = with_fraction(word(91, Group::G4, Meaning::Nothing), 10);
constexpr CommandRow kG92 = stored(92, 0, NonModal::SetCoordinateOffset);
constexpr CommandRow kG92Point1 = stored(92, 10, NonModal::ResetCoordinateOffset);
constexpr CommandRow kG93 = word(93, Group::G5, Meaning::FeedMode, code(FeedMode::InverseTime));
constexpr CommandRow kG94 = word(94, Group::G5, Meaning::FeedMode, code(FeedMode::UnitsPerMinute));

/// G43.1 and G49 of Grbl and Rabbit: both use the axis words, G49 with any fraction.
constexpr CommandRow kG43Point1 =
    claims_first(else_unsupported(claiming(tool_length(43, 10, ToolLengthMode::Dynamic), AxisCommand::ToolLength)));
constexpr CommandRow kG49 = any_fraction(claiming(tool_length(49, 0, ToolLengthMode::None), AxisCommand::ToolLength));

constexpr CommandRow kM0 = flow(0, ProgramFlow::Paused);
constexpr CommandRow kM1Ignored = word(1, Group::M4, Meaning::Nothing);
constexpr CommandRow kM2 = flow(2, ProgramFlow::CompletedM2);
constexpr CommandRow kM3 = spindle(3, SpindleDirection::Clockwise);
constexpr CommandRow kM4 = spindle(4, SpindleDirection::Counterclockwise);
constexpr CommandRow kM5 = spindle(5, SpindleDirection::Off);
constexpr CommandRow kM30 = flow(30, ProgramFlow::CompletedM30);

/// The G words of Grbl and Rabbit. `motion_claim`: whether G0 to G3 ask for the axis words or just take them;
/// `without_contact`: what G38.5 is.
constexpr auto classic_g_words(Claim motion_claim, MotionMode without_contact) {
  return std::array{
      motion(0, MotionMode::Rapid, motion_claim),
      motion(1, MotionMode::Linear, motion_claim),
      motion(2, MotionMode::ClockwiseArc, motion_claim),
      motion(3, MotionMode::CounterclockwiseArc, motion_claim),
      kG4,
      kG10,
      kG17,
      kG18,
      kG19,
      kG20,
      kG21,
      kG28,
      kG28Point1,
      kG30,
      kG30Point1,
      probe(20, MotionMode::ProbeToward, true),
      probe(30, MotionMode::ProbeTowardNoError, true),
      probe(40, MotionMode::ProbeAway, true),
      probe(50, without_contact, true),
      kG40,
      kG43Point1,
      kG49,
      kG53,
      offset(54, 0),
      offset(55, 1),
      offset(56, 2),
      offset(57, 3),
      offset(58, 4),
      offset(59, 5),
      kG61,
      kG80,
      kG90,
      kG91,
      kG91Point1,
      kG92,
      kG92Point1,
      kG93,
      kG94,
  };
}

// gnea/grbl gcode.c: the usual build has no M7 and no M56.
constexpr auto kGrblG = classic_g_words(Claim::IfFree, MotionMode::ProbeAwayNoError);
constexpr CommandRow kGrblM[] = {
    kM0, kM1Ignored, kM2, kM3, kM4, kM5, coolant(8, CoolantWord::Flood), coolant(9, CoolantWord::Off), kM30,
};

// RabbitGRBL GCode.cpp: G0 to G3 take the axis words without asking, and G38.5 probes like G38.4.
constexpr auto kRabbitG = classic_g_words(Claim::Takes, MotionMode::ProbeAway);
constexpr CommandRow kRabbitM[] = {
    kM0,
    kM1Ignored,
    kM2,
    kM3,
    kM4,
    kM5,
    word(6, Group::M6, Meaning::Nothing),
    coolant(7, CoolantWord::Mist),
    coolant(8, CoolantWord::Flood),
    coolant(9, CoolantWord::Off),
    kM30,
    pin(62, PinWord::Digital),
    pin(63, PinWord::Digital),
    pin(64, PinWord::Digital),
    pin(65, PinWord::Digital),
    pin(67, PinWord::Analog),
    pin(68, PinWord::Analog),
};

// grblHAL core gcode.c, without cutter compensation and user M-codes.
constexpr CommandRow kGrblHalG[] = {
    motion(0, MotionMode::Rapid),
    motion(1, MotionMode::Linear),
    motion(2, MotionMode::ClockwiseArc),
    motion(3, MotionMode::CounterclockwiseArc),
    kG4,
    else_unsupported(motion(5, MotionMode::CubicSpline)),
    with_fraction(motion(5, MotionMode::QuadraticSpline), 10),
    word(7, Group::G15, Meaning::Diameter, 1),
    word(8, Group::G15, Meaning::Diameter, 0),
    kG10,
    kG17,
    kG18,
    kG19,
    kG20,
    kG21,
    kG28,
    kG28Point1,
    kG30,
    kG30Point1,
    motion(33, MotionMode::SpindleSynchronized),
    with_fraction(motion(33, MotionMode::RigidTap), 10),
    probe(20, MotionMode::ProbeToward, false),
    probe(30, MotionMode::ProbeTowardNoError, false),
    probe(40, MotionMode::ProbeAway, false),
    probe(50, MotionMode::ProbeAwayNoError, false),
    kG40,
    else_unsupported(claiming(tool_length(43, 10, ToolLengthMode::Dynamic), AxisCommand::ToolLength)),
    word(43, Group::G8, Meaning::TableToolLength, code(ToolLengthMode::FromTable)),
    with_fraction(word(43, Group::G8, Meaning::TableToolLength, code(ToolLengthMode::Additional)), 20),
    any_fraction(tool_length(49, 0, ToolLengthMode::None)),
    claims_first(claiming(word(50, Group::G11, Meaning::Scaling, 0), AxisCommand::Scaling, Claim::Takes)),
    claims_first(claiming(word(51, Group::G11, Meaning::Scaling, 1), AxisCommand::Scaling, Claim::Takes)),
    kG53,
    offset(54, 0),
    offset(55, 1),
    offset(56, 2),
    offset(57, 3),
    offset(58, 4),
    else_unsupported(offset(59, 5)),
    offset(59, 6, 10),
    offset(59, 7, 20),
    offset(59, 8, 30),
    kG61,
    macro(65, 0, MacroCall::NonModal),
    macro(66, 0, MacroCall::Modal),
    macro(66, 10, MacroCall::ModalEachBlock),
    word(67, Group::G16, Meaning::Macro, code(MacroCall::End)),
    motion(73, MotionMode::DrillChipBreak),
    motion(76, MotionMode::Thread),
    with_fraction(motion(76, MotionMode::RigidTap), 10),
    kG80,
    motion(81, MotionMode::Drill),
    motion(82, MotionMode::DrillDwell),
    motion(83, MotionMode::DrillPeck),
    motion(84, MotionMode::Tap),
    motion(85, MotionMode::BoreFeedOut),
    motion(86, MotionMode::BoreSpindleStop),
    motion(89, MotionMode::BoreDwell),
    kG90,
    kG91,
    kG91Point1,
    kG92,
    kG92Point1,
    stored(92, 20, NonModal::ClearCoordinateOffset),
    stored(92, 30, NonModal::RestoreCoordinateOffset),
    kG93,
    kG94,
    word(95, Group::G5, Meaning::FeedMode, code(FeedMode::UnitsPerRevolution)),
    word(96, Group::G14, Meaning::SurfaceSpeed, 1),
    word(97, Group::G14, Meaning::SurfaceSpeed, 0),
    word(98, Group::G10, Meaning::Retract, code(RetractMode::Previous)),
    word(99, Group::G10, Meaning::Retract, code(RetractMode::RPosition)),
};
constexpr CommandRow kGrblHalM[] = {
    kM0,
    word(1, Group::M4, Meaning::OptionalStop),
    kM2,
    kM3,
    kM4,
    kM5,
    word(6, Group::M6, Meaning::ToolChange),
    coolant(7, CoolantWord::Mist),
    coolant(8, CoolantWord::Flood),
    coolant(9, CoolantWord::Off),
    kM30,
    overrides(48, OverrideWord::Enable),
    overrides(49, OverrideWord::Disable),
    overrides(50, OverrideWord::Feed),
    overrides(51, OverrideWord::Spindle),
    overrides(53, OverrideWord::FeedHold),
    word(56, Group::M9, Meaning::ParkingOverride),
    flow(60, ProgramFlow::CompletedM60),
    word(61, Group::M6, Meaning::ToolSet),
    port(62, PortWord::OnWithMotion),
    port(63, PortWord::OffWithMotion),
    port(64, PortWord::On),
    port(65, PortWord::Off),
    port(66, PortWord::Wait),
    port(67, PortWord::AnalogWithMotion),
    port(68, PortWord::Analog),
    saved_state(70, SavedState::Save),
    saved_state(71, SavedState::Invalidate),
    saved_state(72, SavedState::Restore),
    saved_state(73, SavedState::Save),
    word(98, Group::G16, Meaning::Macro, code(MacroCall::Subprogram)),
};

}  // namespace

CommandTable::CommandTable(std::span<const CommandRow> g_rows, std::span<const CommandRow> m_rows)
    : g_rows_(g_rows), m_rows_(m_rows), g_first_(indexed(g_rows)), m_first_(indexed(m_rows)) {}

CommandTable::Index CommandTable::indexed(std::span<const CommandRow> rows) {
  Index first;
  first.fill(kNone);
  for (std::size_t at = rows.size(); at-- > 0;) first[rows[at].number] = static_cast<std::uint8_t>(at);
  return first;
}

std::span<const CommandRow> CommandTable::find(std::span<const CommandRow> rows, const Index& first,
                                               std::uint64_t number) {
  if (number >= kNumbers || first[number] == kNone) return {};
  const std::size_t from = first[number];
  std::size_t to = from + 1;
  while (to < rows.size() && rows[to].number == number) ++to;
  return rows.subspan(from, to - from);
}

const CommandTable& grbl_commands() {
  static const CommandTable table(kGrblG, kGrblM);
  return table;
}

const CommandTable& rabbit_commands() {
  static const CommandTable table(kRabbitG, kRabbitM);
  return table;
}

const CommandTable& grblhal_commands() {
  static const CommandTable table(kGrblHalG, kGrblHalM);
  return table;
}

}  // namespace kerf::gcode
