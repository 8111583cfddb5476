#include "rehearsal/finding.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "common/base/text.hpp"

namespace kerf::rehearsal {
namespace {

using enum FindingKind;
using enum Severity;

/// A line of the file is shown as far as this.
constexpr std::size_t kShownText = 100;

constexpr std::array kRows{
    FindingRow{Refused, Error, "The controller refuses this line",
               "A refused line does not run, and what comes behind it starts from somewhere else.", ""},
    FindingRow{UnknownWord, Error, "This firmware does not have this word",
               "The controller refuses the whole line, so what else it says does not happen either.",
               "Choose a post-processor for this firmware, or take the word out."},
    FindingRow{FeedMissing, Error, "A cut without a feed",
               "The controller does not know how fast to go, and refuses the line.",
               "Put an F word into this line or an earlier one."},
    FindingRow{LineTooLong, Error, "The line is longer than this controller takes",
               "It is refused, or worse: cut in two and run.",
               "Have the post-processor write fewer decimals or shorter lines."},
    FindingRow{SoftLimit, Error, "A move beyond the soft limits", "The controller stops with an alarm in mid-job.",
               "Move the work zero, or make the part or its clearance heights smaller."},
    FindingRow{BeyondTravel, Warning, "A move beyond the travel of the machine",
               "Soft limits do not guard it, so the axis runs against its end, and steps are lost.",
               "Move the work zero, or make the part or its clearance heights smaller."},
    FindingRow{LargerThanMachine, Warning, "The program is larger than the machine",
               "Wherever the work zero lies, the axis runs against one of its ends.",
               "Make the part smaller, or cut it in parts."},
    FindingRow{RapidBelowCut, Warning, "A rapid goes sideways through the stock",
               "What was cut is as high as this rapid or higher, so the tool may crash into what still stands.",
               "Raise the tool before it goes across."},
    FindingRow{RapidIntoStock, Warning, "A rapid goes down into the stock",
               "Nothing was cut there so deep before, so the tool is rammed into the material.",
               "Stop the rapid above the stock, and go on down with G1 and a feed."},
    FindingRow{UnhomedPosition, Warning, "A move to machine coordinates on a machine that is not homed",
               "Machine coordinates then begin where the controller was switched on: the move goes anywhere.",
               "Home the machine first, or go to a place of the work (without G28, G30, G53)."},
    FindingRow{FeedTooHigh, Warning, "The feed is higher than the machine goes",
               "The controller slows down to the axis' maximum, so the job takes longer, and the chips are others.",
               "Lower the feed, or raise the maximum rate if the machine can do it."},
    FindingRow{SpeedOutOfRange, Warning, "The spindle cannot turn at this speed",
               "The controller takes the nearest speed in its range, which is not what the feed was chosen for.",
               "Choose a speed in the range, or set $30 and $31 as the spindle really is."},
    FindingRow{SpeedMissing, Warning, "The spindle is started without a speed",
               "No S word came before, so the controller starts it at speed 0, which on many machines is off.",
               "Put an S word into this line or an earlier one."},
    FindingRow{SpindleOff, Warning, "A cut with the spindle off", "The tool breaks, or the laser stays dark.",
               "Start the spindle (M3 S...) before the cut, unless you switch it by hand."},
    FindingRow{LaserModeOff, Warning, "A laser program on a machine that is not in laser mode",
               "The machine stops at every change of power, and burns where it stands; M4 does not follow the speed.",
               "Set $32=1, unless a spindle is fitted."},
    FindingRow{UnitsMixed, Warning, "Inches and millimetres in one program",
               "A part that was put together from two programs may be 25.4 times too large or too small.",
               "See that each part says its own unit before its first number."},
    FindingRow{UnitsUnsaid, Note, "The program does not say whether it is in inches or millimetres",
               "It is read in the unit that the machine was left in.",
               "Put G21 (millimetres) or G20 at its beginning."},
    FindingRow{
        PlanesMixed, Note, "Arcs in more than one plane",
        "That is right for lead-ins and grooves; a plane that was left on by mistake bends arcs out of the table.",
        "Look at these arcs in a picture if you did not ask for them."},
    FindingRow{StartupLine, Warning, "A startup line of the controller does more than set modes",
               "It runs after power-up, every reset and homing: also when a job was stopped to save the part.",
               "Clear it with $N0= or $N1=, or keep only modes in it."},
    FindingRow{Probing, Warning, "The program probes, and nothing says that a probe is there",
               "Without contact the controller stops with an alarm at the end of the move, or the tool is driven down.",
               "Connect the probe, and see that its contact is reported, before you start."},
    FindingRow{ControllerCommand, Warning, "The program gives a command to the controller itself",
               "It may move the machine or change its settings; what follows cannot be checked as well.",
               "Take it out of the program, and give it by hand."},
    FindingRow{Computed, Warning, "A line that computes",
               "Its values are in the controller only, so what it does, and what follows from it, cannot be checked.",
               "Run it once in the air, or have the CAM program write numbers."},
    FindingRow{ToolUsed, Note, "Another tool is named, and nobody is asked to change it",
               "The machine goes on with the tool that it has.", "Put M6 behind it where the tool has to be changed."},
    FindingRow{ToolChange, Note, "A tool change", "The job waits here until the tool is in.",
               "Have the tool ready, and know how its length is measured."},
    FindingRow{Stop, Note, "The program stops here", "The job waits until you go on.", "Stay near the machine."},
    FindingRow{BehindEnd, Note, "There is more behind the end of the program", "These lines are not sent.",
               "Take out the M2, M30 or % in the middle if they are wanted."},
};

}  // namespace

std::span<const FindingRow> all_finding_rows() {
  return kRows;
}

const FindingRow& row_of(FindingKind kind) {
  return *std::ranges::find(kRows, kind, &FindingRow::kind);
}

FindingGroup& Findings::group_of(FindingKind kind, std::string_view code) {
  for (FindingGroup& group : groups_) {
    if (group.kind == kind && group.code == code) return group;
  }
  return groups_.emplace_back(FindingGroup{.kind = kind, .severity = row_of(kind).severity, .code = std::string{code}});
}

Finding& Findings::keep(FindingGroup& group, std::uint32_t line, std::string_view text, std::string what) {
  const FindingRow& row = row_of(group.kind);
  text = base::trim(text);
  return group.first.emplace_back(
      Finding{.line = line,
              .text = base::escape(text.substr(0, kShownText)) + (text.size() > kShownText ? "..." : ""),
              .severity = group.severity,
              .kind = group.kind,
              .code = group.code,
              .what = std::move(what),
              .reason = std::string{row.reason},
              .next = std::string{row.next}});
}

bool Findings::has(FindingKind kind) const {
  return std::ranges::find(groups_, kind, &FindingGroup::kind) != groups_.end();
}

std::vector<FindingGroup> Findings::take() {
  const auto order = [](const FindingGroup& group) {
    return std::tuple{-static_cast<int>(group.severity), group.first.empty() ? 0 : group.first.front().line};
  };
  std::ranges::sort(groups_, {}, order);
  return std::move(groups_);
}

}  // namespace kerf::rehearsal
