#pragma once
// What a client sees: the state document, as described values. docs/api.md says how it reaches a client.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <boost/describe.hpp>

#include "sender/job/job_state.hpp"
#include "sender/machine/explanation.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::daemon {

enum class LinkPhase {
  Off,       ///< the operator wants no link
  Opening,   ///< the link is being opened
  Greeting,  ///< the handshake is under way, or it found nothing that it can work with
  Ready,     ///< the machine obeys
  Silent,    ///< the link is open, and the machine does not answer
  Lost,      ///< the link is gone, and is opened again as soon as it can be
};
BOOST_DESCRIBE_ENUM(LinkPhase, Off, Opening, Greeting, Ready, Silent, Lost)

struct LinkView {
  LinkPhase phase = LinkPhase::Off;
  /// What was found, or what is wrong.
  std::string sentence{};
  /// On the daemon's clock, which every frame tells.
  double since_s = 0;
  std::optional<double> silent_for_s{};
  std::optional<double> round_trip_s{};
  bool operator==(const LinkView&) const = default;
};
BOOST_DESCRIBE_STRUCT(LinkView, (), (phase, sentence, since_s, silent_for_s, round_trip_s))

struct FirmwareView {
  std::string name{};
  std::string version{};
  std::string build{};
};
BOOST_DESCRIBE_STRUCT(FirmwareView, (), (name, version, build))

/// What the machine's settings say about its body; what they do not say is left out. Machine coordinates, in the order
/// of `axes`.
struct LimitsView {
  std::string axes = "XYZ";
  std::optional<std::vector<double>> min_mm{};
  std::optional<std::vector<double>> max_mm{};
  std::optional<std::vector<double>> max_feed_mm_per_min{};
  std::optional<std::vector<double>> acceleration_mm_per_s2{};
  std::optional<bool> homing_enabled{};
  std::optional<bool> soft_limits{};
  std::optional<bool> laser_mode{};
  std::optional<double> spindle_max_rpm{};
  std::optional<double> spindle_min_rpm{};
};
BOOST_DESCRIBE_STRUCT(LimitsView, (),
                      (axes, min_mm, max_mm, max_feed_mm_per_min, acceleration_mm_per_s2, homing_enabled, soft_limits,
                       laser_mode, spindle_max_rpm, spindle_min_rpm))

struct JobView : job::JobState {
  /// In the library; empty for the rest of a program that was resumed.
  std::string program_id{};
};
BOOST_DESCRIBE_STRUCT(JobView, (job::JobState), (program_id))

enum class PreparationPhase {
  Settling,    ///< what has to be done and asked first
  Checking,    ///< the program is read as the machine will
  Asking,      ///< the operator has to say yes or no
  Rehearsing,  ///< on the virtual controller, for the times
  Refused,     ///< there is no job, and the sentence says why; until it is declined or something else begins
};
BOOST_DESCRIBE_ENUM(PreparationPhase, Settling, Checking, Asking, Rehearsing, Refused)

/// Between Start and the first line.
struct PreparationView {
  PreparationPhase phase = PreparationPhase::Settling;
  std::string sentence{};
  std::optional<std::string> question{};
  /// A plan, findings: lines for people.
  std::vector<std::string> told{};
};
BOOST_DESCRIBE_STRUCT(PreparationView, (), (phase, sentence, question, told))

/// Something is wrong: what, what shows it, and what is safe to do, in that order.
struct TroubleView {
  std::string kind{};
  std::string headline{};
  std::vector<std::string> evidence{};
  std::vector<std::string> steps{};
};
BOOST_DESCRIBE_STRUCT(TroubleView, (), (kind, headline, evidence, steps))

enum class NoteLevel { Note, Warning, Trouble };
BOOST_DESCRIBE_ENUM(NoteLevel, Note, Warning, Trouble)

/// What the operator should know, newest last.
struct NoteView {
  std::uint64_t number = 0;
  /// UTC
  std::string at{};
  NoteLevel level = NoteLevel::Note;
  std::string sentence{};
};
BOOST_DESCRIBE_STRUCT(NoteView, (), (number, at, level, sentence))

/// Whether something can be done right now: empty, or one sentence why not.
struct CanView {
  std::string start{};
  std::string hold{};
  std::string resume{};
  std::string stop{};
  std::string abort{};
  std::string jog{};
  std::string home{};
  std::string unlock{};
  std::string send_line{};
  std::string change_settings{};
  std::string overrides{};
};

struct JogView {
  /// The client that holds the button.
  std::string lease{};
};
BOOST_DESCRIBE_STRUCT(JogView, (), (lease))

/// A job that can go on here.
struct InterruptedView {
  std::int64_t job = 0;
  std::string program{};
  std::string ended{};
  std::uint32_t line = 0;
  std::uint32_t lines = 0;
  std::string reason{};
};
BOOST_DESCRIBE_STRUCT(InterruptedView, (), (job, program, ended, line, lines, reason))

struct MachineView {
  std::string name{};
  std::string url{};
  bool is_virtual = false;
  LinkView link{};
  /// What the machine does that Kerf did not start.
  std::optional<std::string> busy{};
  machine::Snapshot snapshot{};
  LimitsView limits{};
  FirmwareView firmware{};
  std::optional<JobView> job{};
  /// In the library.
  std::optional<std::string> program{};
  std::optional<PreparationView> preparation{};
  std::optional<TroubleView> trouble{};
  std::vector<NoteView> notes{};
  CanView can{};
  std::optional<JogView> jog{};
  std::vector<InterruptedView> interrupted{};
};

struct ProgramView {
  std::string name{};
  std::uint64_t bytes = 0;
  std::uint64_t lines = 0;
  /// UTC
  std::string added_at{};
  bool example = false;
};
BOOST_DESCRIBE_STRUCT(ProgramView, (), (name, bytes, lines, added_at, example))

struct ServerView {
  std::string name = "Kerf";
  std::string version{};
  /// UTC
  std::string started_at{};
};
BOOST_DESCRIBE_STRUCT(ServerView, (), (name, version, started_at))

struct StateView {
  ServerView server{};
  std::map<std::string, MachineView> machines{};
  std::map<std::string, ProgramView> programs{};
};

BOOST_DESCRIBE_STRUCT(CanView, (),
                      (start, hold, resume, stop, abort, jog, home, unlock, send_line, change_settings, overrides))
BOOST_DESCRIBE_STRUCT(MachineView, (),
                      (name, url, is_virtual, link, busy, snapshot, limits, firmware, job, program, preparation,
                       trouble, notes, can, jog, interrupted))
BOOST_DESCRIBE_STRUCT(StateView, (), (server, machines, programs))

}  // namespace kerf::daemon
