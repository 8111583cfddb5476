#pragma once
// What a client may ask of a machine, as described values: docs/api.md, "Commands". Each is an object with its name in
// `command` and its members beside it.

#include <array>
#include <cstdint>
#include <expected>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boost/describe.hpp>

#include "io/json_reading.hpp"
#include "sender/job/wire_form.hpp"
#include "sender/machine/settings_plan.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::daemon {

struct Connect {};
struct Disconnect {};
struct Hold {};
struct Resume {};
struct Stop {};
struct Abort {};
struct SoftReset {};
struct Unlock {};
struct Home {};
struct CancelJog {};
struct TakeControl {};
/// Which program of the library is on this machine.
struct Load {
  std::string program;
};
/// Checks the program that is loaded, and cuts it.
struct Start {
  std::optional<std::uint32_t> from_line{};
  bool despite_errors = false;
  job::ProgramSwitch optional_stop = job::ProgramSwitch::AsMachine;
  job::ProgramSwitch block_delete = job::ProgramSwitch::AsMachine;
};
/// The answers to the question of a preparation.
struct Agree {};
struct Decline {};
/// Prepares a verified resume of a job of the journal.
struct ResumeJob {
  std::int64_t job = 0;
};
struct DismissJob {
  std::int64_t job = 0;
};
/// By axis letter, mm.
struct JogStep {
  std::map<std::string, double> distance{};
  double feed_mm_per_min = 0;
};
enum class PositionSystem { Work, Machine };
BOOST_DESCRIBE_ENUM(PositionSystem, Work, Machine)
/// First up, then along, and down only where Z is given.
struct GoTo {
  std::map<std::string, double> position{};
  PositionSystem system = PositionSystem::Work;
  std::optional<double> feed_mm_per_min{};
};
/// The work position of these axes becomes 0.
struct SetZero {
  std::string axes;
  std::optional<std::string> system{};
};
struct SelectSystem {
  std::string system;
};
struct SendLine {
  std::string text;
};
struct SetOverride {
  std::optional<int> feed{};
  std::optional<int> rapid{};
  std::optional<int> spindle{};
};
struct Spindle {
  machine::SpindleTurn turn = machine::SpindleTurn::Off;
  std::optional<double> rpm{};
};
/// What is left out stays as it is.
struct Coolant {
  std::optional<bool> flood{};
  std::optional<bool> mist{};
};
struct ChangeSettings {
  std::vector<machine::SettingAssignment> settings{};
  std::string reason{};
};
/// A version of the settings' history.
struct RollbackSettings {
  int version = 0;
};

using Command = std::variant<Connect, Disconnect, Hold, Resume, Stop, Abort, SoftReset, Unlock, Home, CancelJog,
                             TakeControl, Load, Start, Agree, Decline, ResumeJob, DismissJob, JogStep, GoTo, SetZero,
                             SelectSystem, SendLine, SetOverride, Spindle, Coolant, ChangeSettings, RollbackSettings>;

/// In the order of the variant.
inline constexpr std::array<std::string_view, std::variant_size_v<Command>> kCommandNames{
    "Connect",   "Disconnect",     "Hold",
    "Resume",    "Stop",           "Abort",
    "SoftReset", "Unlock",         "Home",
    "CancelJog", "TakeControl",    "Load",
    "Start",     "Agree",          "Decline",
    "ResumeJob", "DismissJob",     "JogStep",
    "GoTo",      "SetZero",        "SelectSystem",
    "SendLine",  "SetOverride",    "Spindle",
    "Coolant",   "ChangeSettings", "RollbackSettings",
};
static_assert(!kCommandNames.back().empty(), "name the new command here, in the order of the variant");

/// The command of an object of which `command` is its name; what is not of the command has been taken out.
[[nodiscard]] std::expected<Command, io::JsonFault> parse_command(std::string_view name, const io::Json& members);

/// It makes the machine stop, or less likely to move: obeyed for everybody, at any time.
[[nodiscard]] bool is_for_safety(const Command& command);

enum class Outcome {
  Accepted,
  Refused,  ///< not now; the sentence says why
  Invalid,  ///< never, like this
};
BOOST_DESCRIBE_ENUM(Outcome, Accepted, Refused, Invalid)

struct CommandAnswer {
  Outcome outcome = Outcome::Accepted;
  /// A word for programs, where it was not accepted.
  std::string reason{};
  std::string sentence{};
};
BOOST_DESCRIBE_STRUCT(CommandAnswer, (), (outcome, reason, sentence))

BOOST_DESCRIBE_STRUCT(Connect, (), ())
BOOST_DESCRIBE_STRUCT(Disconnect, (), ())
BOOST_DESCRIBE_STRUCT(Hold, (), ())
BOOST_DESCRIBE_STRUCT(Resume, (), ())
BOOST_DESCRIBE_STRUCT(Stop, (), ())
BOOST_DESCRIBE_STRUCT(Abort, (), ())
BOOST_DESCRIBE_STRUCT(SoftReset, (), ())
BOOST_DESCRIBE_STRUCT(Unlock, (), ())
BOOST_DESCRIBE_STRUCT(Home, (), ())
BOOST_DESCRIBE_STRUCT(CancelJog, (), ())
BOOST_DESCRIBE_STRUCT(TakeControl, (), ())
BOOST_DESCRIBE_STRUCT(Load, (), (program))
BOOST_DESCRIBE_STRUCT(Start, (), (from_line, despite_errors, optional_stop, block_delete))
BOOST_DESCRIBE_STRUCT(Agree, (), ())
BOOST_DESCRIBE_STRUCT(Decline, (), ())
BOOST_DESCRIBE_STRUCT(ResumeJob, (), (job))
BOOST_DESCRIBE_STRUCT(DismissJob, (), (job))
BOOST_DESCRIBE_STRUCT(JogStep, (), (distance, feed_mm_per_min))
BOOST_DESCRIBE_STRUCT(GoTo, (), (position, system, feed_mm_per_min))
BOOST_DESCRIBE_STRUCT(SetZero, (), (axes, system))
BOOST_DESCRIBE_STRUCT(SelectSystem, (), (system))
BOOST_DESCRIBE_STRUCT(SendLine, (), (text))
BOOST_DESCRIBE_STRUCT(SetOverride, (), (feed, rapid, spindle))
BOOST_DESCRIBE_STRUCT(Spindle, (), (turn, rpm))
BOOST_DESCRIBE_STRUCT(Coolant, (), (flood, mist))
BOOST_DESCRIBE_STRUCT(ChangeSettings, (), (settings, reason))
BOOST_DESCRIBE_STRUCT(RollbackSettings, (), (version))

}  // namespace kerf::daemon
