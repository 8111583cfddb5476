#include "common/vocabulary/report_mask.hpp"

#include <array>

namespace kerf::vocabulary {
namespace {

constexpr auto kAll = FirmwareSet::All;
constexpr auto kHal = FirmwareSet::GrblHal;

constexpr std::array kRows{
    ReportBitRow{ReportBit::MachinePosition, "machine position", "MPos instead of WPos.", kAll},
    ReportBitRow{ReportBit::BufferState, "buffer state", "Bf: free planner blocks and receive bytes.", kAll},
    ReportBitRow{ReportBit::LineNumbers, "line numbers", "Ln: the N word that is being executed.", kHal},
    ReportBitRow{ReportBit::FeedAndSpeed, "feed and speed", "FS: feed and spindle speed.", kHal},
    ReportBitRow{ReportBit::PinState, "pin state", "Pn: inputs that are active.", kHal},
    ReportBitRow{ReportBit::WorkOffset, "work offset", "WCO: what work coordinates differ by.", kHal},
    ReportBitRow{ReportBit::Overrides, "overrides", "Ov and A: overrides and what is switched on.", kHal},
    ReportBitRow{ReportBit::ProbeCoordinates, "probe coordinates", "[PRB:] is pushed after each probing.", kHal},
    ReportBitRow{ReportBit::SyncOnWorkOffsetChange, "sync on offset change",
                 "Motion ends before a work offset changes, so that reports stay true.", kHal},
    ReportBitRow{ReportBit::ParserState, "parser state", "[GC:] is pushed after a report when modes changed.", kHal},
    ReportBitRow{ReportBit::AlarmSubstate, "alarm substate", "Alarm with its code, as in Alarm:3.", kHal},
    ReportBitRow{ReportBit::RunSubstate, "run substate", "Run:1 hold pending, Run:2 probing.", kHal},
    ReportBitRow{ReportBit::ReportWhenHoming, "report when homing", "Status queries are answered while homing.", kHal},
    ReportBitRow{ReportBit::DistanceToGo, "distance to go", "DTG: what is left of the block that is executing.", kHal},
};

}  // namespace

std::span<const ReportBitRow> report_bit_rows() {
  return kRows;
}

}  // namespace kerf::vocabulary
