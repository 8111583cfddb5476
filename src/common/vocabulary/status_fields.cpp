#include "common/vocabulary/status_fields.hpp"

namespace kerf::vocabulary {
namespace {

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;
constexpr auto kGrblAndHal = FirmwareSet::Grbl | FirmwareSet::GrblHal;

// protocol.md 3.1
constexpr std::array kRows{
    StatusFieldRow{StatusField::MachinePosition, "MPos", "x,y,z",
                   "Machine position. One of MPos and WPos is in every report.", kAll, ReportBit::MachinePosition},
    StatusFieldRow{StatusField::WorkPosition, "WPos", "x,y,z", "Work position: MPos less WCO.", kAll, {}},
    StatusFieldRow{StatusField::Buffer, "Bf", "blocks,bytes", "Free planner blocks and free receive bytes.", kAll,
                   ReportBit::BufferState},
    StatusFieldRow{StatusField::LineNumber, "Ln", "n", "N word of the block that is executing; left out when zero.",
                   kGrblAndHal, ReportBit::LineNumbers},
    StatusFieldRow{StatusField::DistanceToGo, "DTG", "x,y,z", "What is left of the block that is executing, signed.",
                   kHal, ReportBit::DistanceToGo},
    StatusFieldRow{StatusField::FeedAndSpeed, "FS", "feed,rpm[,measured]",
                   "Actual feed and programmed spindle speed; the measured one with an encoder or a VFD.", kAll,
                   ReportBit::FeedAndSpeed},
    StatusFieldRow{StatusField::Feed, "F", "feed", "Actual feed, in builds without variable spindle.", kAll,
                   ReportBit::FeedAndSpeed},
    StatusFieldRow{StatusField::ExtraSpindle,
                   "SP",
                   "rpm,,[S|C][,percent]",
                   "One for each further spindle, its number in the name.",
                   kHal,
                   {}},
    StatusFieldRow{StatusField::ActiveSpindle, "S", "n", "The spindle in use, on change.", kHal, {}},
    StatusFieldRow{StatusField::Pins, "Pn", "letters", "Inputs that are active; absent when none is.", kAll,
                   ReportBit::PinState},
    StatusFieldRow{StatusField::WorkOffset, "WCO", "x,y,z",
                   "What work coordinates differ by, tool length included; on change and now and then.", kAll,
                   ReportBit::WorkOffset},
    StatusFieldRow{StatusField::WorkCoordinateSystem, "WCS", "G54", "The work coordinate system, on change.", kHal, {}},
    StatusFieldRow{StatusField::Overrides, "Ov", "feed,rapid,spindle",
                   "Overrides in percent; on change and now and then.", kAll, ReportBit::Overrides},
    StatusFieldRow{StatusField::Accessories, "A", "letters",
                   "What is switched on. Grbl and Rabbit: only together with Ov, and absent there means all off.", kAll,
                   ReportBit::Overrides},
    StatusFieldRow{StatusField::Scaling, "Sc", "axes", "Axes that G51 scales; may be empty. On change.", kHal, {}},
    StatusFieldRow{
        StatusField::AutoReport, "AR", "[ms]", "Period of automatic reports; without a value they are off.", kHal, {}},
    StatusFieldRow{
        StatusField::Mpg, "MPG", "0|1", "A pendant has control. 0 in a full report means nothing.", kHal, {}},
    StatusFieldRow{StatusField::Homed,
                   "H",
                   "0|1[,mask]",
                   "All axes that need it are homed; the mask of those that are, with single-axis homing.",
                   kHal,
                   {}},
    StatusFieldRow{StatusField::Diameter, "D", "0|1", "Lathe: X is a diameter.", kHal, {}},
    StatusFieldRow{StatusField::Tool, "T", "n", "The tool in use, on change.", kHal, {}},
    StatusFieldRow{StatusField::Probe, "P", "n[,P]", "The probe in use, and whether it is protected.", kHal, {}},
    StatusFieldRow{StatusField::ToolLengthReference, "TLR", "0|1", "A tool length reference is set.", kHal, {}},
    StatusFieldRow{StatusField::InputResult, "In", "n", "Result of M66, once; -1 on time-out.", kHal, {}},
    StatusFieldRow{StatusField::PluginFields, "", "", "Fields that plugins add.", kHal, {}},
    StatusFieldRow{StatusField::FirmwareName,
                   "FW",
                   "name",
                   "The firmware, in full reports up to compatibility level 1.",
                   kHal,
                   {}},
    StatusFieldRow{StatusField::CriticalEvent, "$C", "1", "Only a reset helps; in full reports.", kHal, {}},
};

constexpr std::array kPluginRows{
    PluginFieldRow{"SD", "File job: percent and name, Pending, or the mount state 0 to 3."},
    PluginFieldRow{"Fan", "Fans that are on."},
    PluginFieldRow{"THC", "Torch height control of plasma machines."},
    PluginFieldRow{"Enc", "Encoder mode."},
    PluginFieldRow{"PWM", "Spindle or laser PWM."},
};

// Rows stand at their enumerator's place, so row_of needs no search.
static_assert([] {
  for (std::size_t index = 0; index < kRows.size(); ++index) {
    if (static_cast<std::size_t>(kRows[index].field) != index) return false;
  }
  return true;
}());

}  // namespace

std::span<const StatusFieldRow> status_field_rows() {
  return kRows;
}

const StatusFieldRow& row_of(StatusField field) {
  return kRows.at(static_cast<std::size_t>(field));
}

std::span<const PluginFieldRow> plugin_field_rows() {
  return kPluginRows;
}

}  // namespace kerf::vocabulary
