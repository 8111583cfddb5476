#pragma once
// What `kerf check` finds in a program, as values: one row for each kind of finding with its sentences.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/describe.hpp>

namespace kerf::rehearsal {

/// An error is what this controller would refuse or answer with an alarm, and nothing else is.
enum class Severity : std::uint8_t { Note, Warning, Error };
BOOST_DESCRIBE_ENUM(Severity, Note, Warning, Error)

enum class FindingKind : std::uint8_t {
  Refused,
  UnknownWord,
  FeedMissing,
  LineTooLong,
  SoftLimit,
  BeyondTravel,
  LargerThanMachine,
  RapidBelowCut,
  RapidIntoStock,
  UnhomedPosition,
  FeedTooHigh,
  SpeedOutOfRange,
  SpeedMissing,
  SpindleOff,
  LaserModeOff,
  UnitsMixed,
  UnitsUnsaid,
  PlanesMixed,
  StartupLine,
  Probing,
  ControllerCommand,
  Computed,
  ToolUsed,
  ToolChange,
  Stop,
  BehindEnd,
};
BOOST_DESCRIBE_ENUM(FindingKind, Refused, UnknownWord, FeedMissing, LineTooLong, SoftLimit, BeyondTravel,
                    LargerThanMachine, RapidBelowCut, RapidIntoStock, UnhomedPosition, FeedTooHigh, SpeedOutOfRange,
                    SpeedMissing, SpindleOff, LaserModeOff, UnitsMixed, UnitsUnsaid, PlanesMixed, StartupLine, Probing,
                    ControllerCommand, Computed, ToolUsed, ToolChange, Stop, BehindEnd)

/// What is true of all findings of a kind.
struct FindingRow {
  FindingKind kind{};
  Severity severity{};
  std::string_view title;   ///< what it is, for a headline
  std::string_view reason;  ///< why that matters
  std::string_view next;    ///< what to do
};

[[nodiscard]] const FindingRow& row_of(FindingKind kind);
[[nodiscard]] std::span<const FindingRow> all_finding_rows();

struct Finding {
  std::uint32_t line = 0;  ///< of the file, from 1; 0 where it is no line's fault
  std::string text{};      ///< the line as the file has it; a long one is cut
  Severity severity{};
  FindingKind kind{};
  std::string code{};    ///< what the controller says: "error:20", "ALARM:2"; empty where it says nothing
  std::string what{};    ///< about this line, a sentence
  std::string reason{};  ///< why that matters
  std::string next{};    ///< what to do
  bool operator==(const Finding&) const = default;
};
BOOST_DESCRIBE_STRUCT(Finding, (), (line, text, severity, kind, code, what, reason, next))

/// All findings of one kind and code: the first ones, and how many there are.
struct FindingGroup {
  FindingKind kind{};
  Severity severity{};
  std::string code{};
  std::uint64_t count = 0;
  std::uint32_t last_line = 0;
  std::vector<Finding> first{};
  bool operator==(const FindingGroup&) const = default;
};
BOOST_DESCRIBE_STRUCT(FindingGroup, (), (kind, severity, code, count, last_line, first))

/// Collects findings. Memory does not grow with the program: of many alike the first are kept.
class Findings {
 public:
  static constexpr std::size_t kKept = 8;

  /// A sentence about the line is only made where it is kept: `what()` gives it. Gives the finding, if it is kept.
  template <typename What>
  Finding* add(FindingKind kind, std::uint32_t line, std::string_view text, const What& what,
               std::string_view code = {}) {
    FindingGroup& group = group_of(kind, code);
    ++group.count;
    group.last_line = line;
    return group.first.size() < kKept ? &keep(group, line, text, what()) : nullptr;
  }

  [[nodiscard]] bool has(FindingKind kind) const;
  /// The worst first, then in the order of their first lines.
  [[nodiscard]] std::vector<FindingGroup> take();

 private:
  [[nodiscard]] FindingGroup& group_of(FindingKind kind, std::string_view code);
  static Finding& keep(FindingGroup& group, std::uint32_t line, std::string_view text, std::string what);

  std::vector<FindingGroup> groups_;
};

}  // namespace kerf::rehearsal
