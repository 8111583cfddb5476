#pragma once
// The sub-commands of `kerf`: what main() found in the command line, and one function each. Every function prints for
// people (or JSON where asked), says errors in one sentence on standard error, and returns how the program ends.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/exit_status.hpp"
#include "io/recording_options.hpp"
#include "rehearsal/plot_painter.hpp"
#include "sender/session/job_options.hpp"

namespace kerf::apps {

inline constexpr const char* kDefaultMachine = "virtual:grblhal";

/// How a job goes on in the middle of its program.
struct ResumeChoices {
  std::optional<std::uint32_t> from_line{};
  std::optional<double> safe_height_mm{};
  std::optional<double> plunge_mm_per_min{};
  std::optional<double> spin_up_s{};
  std::string offsets = "agree";  ///< agree, present, job
  bool position_is_right = false;
  bool dry_run = false;
  bool yes = false;
};

/// How lines are fed, and what a refused one means.
struct JobChoices {
  session::JobOptions options{};
  /// Empty: hold and ask if there is somebody to be asked, else stop.
  std::optional<job::ErrorPolicy> on_error{};

  [[nodiscard]] session::JobOptions settled(bool can_ask) const {
    session::JobOptions job = options;
    job.on_error = on_error.value_or(can_ask ? job::ErrorPolicy::HoldAndAsk : job::ErrorPolicy::Stop);
    return job;
  }
};

struct RunOptions {
  std::string file;
  std::string machine = kDefaultMachine;
  bool json = false;
  bool despite_errors = false;  ///< of the check before the job
  ResumeChoices start{};
  io::RecordingOptions recording{};
  JobChoices job{};
};
[[nodiscard]] ExitStatus run(const RunOptions& options);

/// `kerf resume`.
struct ResumeOptions {
  bool list = false;  ///< only say which jobs could be resumed
  bool json = false;
  std::optional<std::int64_t> job{};  ///< empty: the newest that was interrupted
  std::string file;                   ///< empty: where it was
  std::string machine;                ///< empty: the machine of the job
  ResumeChoices choices{};
  JobChoices how{};
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus resume(const ResumeOptions& options);
[[nodiscard]] ExitStatus resume_job(const ResumeOptions& options);
/// `kerf run --from-line`.
[[nodiscard]] ExitStatus run_from_line(const RunOptions& options);

/// `kerf audit`.
struct AuditOptions {
  std::string machine = kDefaultMachine;
  std::string axes;  ///< empty: all that home
  double tolerance_mm = 0.05;
  bool history = false;  ///< only list the audits of before
  bool json = false;
  bool yes = false;
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus audit(const AuditOptions& options);

/// `kerf serve`.
struct ServeOptions {
  std::string listen = "127.0.0.1:8080";
  std::vector<std::string> machines{};
  std::string program{};
  std::string state_folder{};  ///< empty: the user's own
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus serve(const ServeOptions& options);

struct VirtualOptions {
  std::string personality = "grblhal";
  std::vector<std::string> listen;  ///< one for all machines, or one each
  std::vector<std::string> ptys;    ///< the same
  std::size_t count = 1;
  std::string speed = "1";
  std::string settings_file;
  std::string state_file;
  std::string card_folder;
  std::string pendant;
  std::optional<int> axes;
  std::optional<int> tools;
  std::string ports;
  bool slow_memory = false;
  bool spindle_encoder = false;
  bool welcome_on_connect = false;
  std::vector<std::string> scripts;
  std::string control;
  std::string log_file;
};
[[nodiscard]] ExitStatus serve_virtual(const VirtualOptions& options);

struct DescribeOptions {
  std::string machine = kDefaultMachine;
  bool json = false;
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus describe_machine(const DescribeOptions& options);

/// `kerf settings COMMAND`. `sets` are files, `@NUMBER` of the history, or `now` for the machine as it is.
struct SettingsOptions {
  std::string machine = kDefaultMachine;
  bool json = false;
  std::vector<std::string> items;  ///< `get`: ids; `set`: `ID=VALUE`
  std::vector<std::string> sets;
  std::string group;
  std::string reason;
  bool verbose = false;
  bool dry_run = false;
  bool force = false;
  bool allows_motion = false;  ///< a startup line may move the machine
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus list_settings(const SettingsOptions& options);
[[nodiscard]] ExitStatus get_settings(const SettingsOptions& options);
[[nodiscard]] ExitStatus set_settings(const SettingsOptions& options);
[[nodiscard]] ExitStatus diff_settings(const SettingsOptions& options);
[[nodiscard]] ExitStatus save_settings(const SettingsOptions& options);
[[nodiscard]] ExitStatus restore_settings(const SettingsOptions& options);
[[nodiscard]] ExitStatus list_settings_history(const SettingsOptions& options);

struct StatusOptions {
  std::string machine = kDefaultMachine;
  bool json = false;
  bool watch = false;  ///< go on until interrupted
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus show_status(const StatusOptions& options);

/// `kerf alarms` and `kerf errors`.
struct CodesOptions {
  std::string machine = kDefaultMachine;
  std::string personality;  ///< Kerf's own tables of this firmware instead of a machine's
  std::optional<int> code;  ///< explain this one
  bool errors = false;      ///< errors, not alarms
  bool json = false;
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus list_codes(const CodesOptions& options);

struct ConsoleOptions {
  std::string machine = kDefaultMachine;
  io::RecordingOptions recording{};
  bool may_reset = false;
  bool verbose = false;  ///< also each step of the handshake
};
[[nodiscard]] ExitStatus console(const ConsoleOptions& options);

struct PortsOptions {
  bool json = false;
  bool network = false;  ///< listen to what announces itself
  bool watch = false;    ///< go on and tell what comes and goes
};
[[nodiscard]] ExitStatus list_ports(const PortsOptions& options);

struct VerifyOptions {
  std::vector<std::string> files;
  std::string machine;      ///< empty: the virtual controller of each talk's personality, in virtual time
  std::string personality;  ///< empty: all of them
  bool verbose = false;
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus verify(const VerifyOptions& options);

/// A virtual machine for `conform` and `simulate`.
struct CaseMachineOptions {
  std::string personality = "grblhal";
  std::string settings_file;
  std::string limit_switches;              ///< `X,Y,Z` in mm from the power-up position; empty: there are none
  std::optional<double> probe_contact_mm;  ///< none: there is nothing to touch
};

struct ConformOptions {
  std::string file;
  CaseMachineOptions machine;
};
[[nodiscard]] ExitStatus conform(const ConformOptions& options);

struct SimulateOptions {
  std::string file;
  CaseMachineOptions machine;
  bool json = false;
  std::string trace_file;
  std::string positions_file;
  double every_s = 0.01;
  std::vector<std::string> inject;
  std::string link = "saturated";
};
[[nodiscard]] ExitStatus simulate(const SimulateOptions& options);

struct EstimateOptions {
  std::string file;
  CaseMachineOptions virtual_machine;
  std::string machine;  ///< not empty: asked for its firmware and settings
  std::string link = "saturated";
  bool json = false;
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus estimate(const EstimateOptions& options);

struct CheckOptions {
  std::string file;
  CaseMachineOptions virtual_machine;
  std::string machine;   ///< not empty: asked for its firmware, settings, offsets and position
  std::string zero;      ///< `X,Y,Z` in machine coordinates; empty: nobody knows
  std::string position;  ///< the same
  bool json = false;
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus check(const CheckOptions& options);

struct PlotCommandOptions {
  std::string file;
  std::string output;
  rehearsal::PlotView view = rehearsal::PlotView::Isometric;
  std::optional<rehearsal::PlotColour> colour{};
  std::string size = "1200x900";
  CaseMachineOptions machine;
};
[[nodiscard]] ExitStatus plot(const PlotCommandOptions& options);

/// An option that is a transform, as it was written.
struct TransformStepText {
  std::string option;  ///< "--rotate"
  std::string value;
};

struct TransformOptions {
  std::string file;
  std::vector<TransformStepText> steps;  ///< in the order of the command line
  std::string output;                    ///< empty or "-": standard output
  bool previews = false;
  bool splits_tools = false;            ///< a file for each tool
  std::string personality = "grblhal";  ///< it knows the most words
};
[[nodiscard]] ExitStatus transform(const TransformOptions& options);

struct ReportOptions {
  std::string file;
  std::string output;
  CaseMachineOptions virtual_machine;
  std::string machine;  ///< not empty: asked for its firmware and settings
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus report(const ReportOptions& options);

struct RecordOptions {
  std::string machine = kDefaultMachine;
  bool listens = false;        ///< send nothing at all
  bool shows_reports = false;  ///< status reports too
  bool quiet = false;
  io::RecordingOptions recording{};
};
[[nodiscard]] ExitStatus record(const RecordOptions& options);

struct LogListOptions {
  std::string folder;  ///< empty: the user's own
  bool json = false;
};
[[nodiscard]] ExitStatus list_logs(const LogListOptions& options);

struct LogShowOptions {
  std::string log = "latest";
  std::string direction = "both";
  std::vector<std::string> kinds;
  std::vector<std::string> hidden;
  std::string since;
  std::string until;
  std::string pattern;
  bool by_clock = false;
  bool json = false;
};
[[nodiscard]] ExitStatus show_log(const LogShowOptions& options);

struct ReplayOptions {
  std::string log;
  std::string program;  ///< a file, for a program that is too large to be in the log
  bool verbose = false;
  bool json = false;
};
[[nodiscard]] ExitStatus replay(const ReplayOptions& options);

/// Says what went wrong on standard error, as one sentence behind the program's name.
void complain(const std::string& sentence);

}  // namespace kerf::apps
