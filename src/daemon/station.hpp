#pragma once
// A machine that the daemon owns: its link, its session, what is loaded on it, and what clients see of it. It connects
// and comes back by itself, and never moves by itself. Loop's thread only.

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/command.hpp"
#include "daemon/job_starter.hpp"
#include "daemon/machine_view.hpp"
#include "daemon/notes.hpp"
#include "daemon/program_library.hpp"
#include "daemon/traffic.hpp"
#include "io/session_host.hpp"
#include "io/sleep_inhibitor.hpp"
#include "io/worker_pool.hpp"
#include "preparation/interrupted_jobs.hpp"
#include "sender/session/jog_lease.hpp"
#include "sender/session/override_pursuit.hpp"

namespace kerf::daemon {

/// What every station of a daemon uses.
struct StationServices {
  io::EventLoop* loop = nullptr;
  io::WorkerPool* pool = nullptr;
  Store* store = nullptr;
  ProgramLibrary* library = nullptr;
  io::RecordingOptions recording{};
};

/// A button that is held: which way, by axis letter, -1 to 1.
struct JogPress {
  std::map<std::string, double> direction{};
  double feed_mm_per_min = 0;
};
BOOST_DESCRIBE_STRUCT(JogPress, (), (direction, feed_mm_per_min))

class Station {
 public:
  struct Callbacks {
    /// What clients see may have changed.
    std::function<void()> changed;
    /// Lines came or went.
    std::function<void()> traffic;
  };

  /// `url` is one that parse_machine_url() takes.
  Station(const StationServices& services, MachineRow row, io::MachineUrl url, Callbacks callbacks);
  /// A running job is held; its journal is closed.
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  [[nodiscard]] MachineView view() const;
  [[nodiscard]] const MachineRow& row() const { return row_; }
  [[nodiscard]] const io::MachineUrl& url() const { return url_; }
  [[nodiscard]] const Traffic& traffic() const { return traffic_; }
  /// Null while there is no link.
  [[nodiscard]] const session::Session* session() const { return host_ ? &host_->session() : nullptr; }
  [[nodiscard]] bool has_job() const;
  /// A job is under way, or being prepared.
  [[nodiscard]] bool is_busy() const;
  [[nodiscard]] bool has_loaded(const std::string& program) const { return program_ && program_->id == program; }

  [[nodiscard]] CommandAnswer obey(const Command& command);

  /// `client` holds a button, and keeps holding it, and has let go or is gone.
  [[nodiscard]] CommandAnswer press_jog(const std::string& client, const JogPress& press);
  void renew_jog(const std::string& client);
  void release_jog(const std::string& client);

 private:
  // Link and events.
  void connect();
  void disconnect();
  void retry_later();
  void on_event(const session::Event& event);
  void on_link_lost(const io::TransportError& error, bool comes_back);
  void on(const session::ControllerFound& found);
  void on(const session::FirmwareIdentified& identified);
  void on(const session::ControllerReset& reset);
  void on(const session::ControllerBusy& busy);
  void on(const session::ControllerRestarted& restarted);
  void on(const session::HandshakeNoted& noted);
  void on(const session::HandshakeFailed& failed);
  void on(const session::StatusReported& reported);
  void on(const session::CommandRefused& refused);
  void on(const session::AlarmRaised& alarm);
  void on(const session::LineRefused& refused);
  void on(const session::LineSent& line);
  void on(const session::LineReceived& line);
  void on(const session::LinkSilent& silent);
  void on(const session::LinkAnswering& answering);
  void on(const session::PendantTookOver& taken);
  void on(const session::PendantReleased& released);
  void on(const session::JobStarted& started);
  void on(const session::JobStalled& stalled);
  void on(const session::JobEnded& ended);
  void on(const session::PathUnwatched& unwatched);
  void on(const session::ProgramSpoke& spoke);
  void on(const session::SettingsChanged& changed);
  void on(const session::SettingsDrifted& drifted);
  template <typename Other>
  void on(const Other&) {}
  void look_for_interrupted();

  // Commands.
  CommandAnswer do_it(const Connect& command);
  CommandAnswer do_it(const Disconnect& command);
  CommandAnswer do_it(const Hold& command);
  CommandAnswer do_it(const Resume& command);
  CommandAnswer do_it(const Stop& command);
  CommandAnswer do_it(const Abort& command);
  CommandAnswer do_it(const SoftReset& command);
  CommandAnswer do_it(const Unlock& command);
  CommandAnswer do_it(const Home& command);
  CommandAnswer do_it(const CancelJog& command);
  CommandAnswer do_it(const TakeControl& command);
  CommandAnswer do_it(const Load& command);
  CommandAnswer do_it(const Start& command);
  CommandAnswer do_it(const Agree& command);
  CommandAnswer do_it(const Decline& command);
  CommandAnswer do_it(const ResumeJob& command);
  CommandAnswer do_it(const DismissJob& command);
  CommandAnswer do_it(const JogStep& command);
  CommandAnswer do_it(const GoTo& command);
  CommandAnswer do_it(const SetZero& command);
  CommandAnswer do_it(const SelectSystem& command);
  CommandAnswer do_it(const SendLine& command);
  CommandAnswer do_it(const SetOverride& command);
  CommandAnswer do_it(const Spindle& command);
  CommandAnswer do_it(const Coolant& command);
  CommandAnswer do_it(const ChangeSettings& command);
  CommandAnswer do_it(const RollbackSettings& command);
  CommandAnswer submit(const session::Command& command);
  CommandAnswer send_line(std::string text) { return submit(session::SendLine{std::move(text)}); }
  CommandAnswer jog_to(const std::string& words);

  // Held jogs and overrides.
  void send_jogs();
  void end_jog();
  [[nodiscard]] std::optional<double> room_along(const std::array<double, vocabulary::kMaxAxes>& direction) const;

  // The view.
  [[nodiscard]] LinkView link_view() const;
  [[nodiscard]] LimitsView limits_of(const machine::Capabilities& known) const;
  [[nodiscard]] CanView can_view() const;
  [[nodiscard]] std::optional<TroubleView> trouble_view() const;
  [[nodiscard]] bool is_ready() const;
  void set_phase(LinkPhase phase, std::string sentence);

  const StationServices services_;
  const MachineRow row_;
  const io::MachineUrl url_;
  const Callbacks callbacks_;
  io::Timer jog_timer_;
  io::Timer look_timer_;
  io::Timer retry_timer_;
  io::Timer silence_timer_;
  Notes notes_;
  Traffic traffic_;

  LinkPhase phase_ = LinkPhase::Off;
  std::string phase_sentence_;
  Instant phase_since_{};
  int attempt_ = 0;
  bool is_identified_ = false;
  std::optional<std::string> busy_;
  LimitsView limits_;
  std::optional<machine::Explanation> last_refusal_;
  std::optional<session::CommandRefused> refusal_;

  SharedProgram program_;
  std::string job_program_;
  JobStarter starter_;
  std::unique_ptr<io::SleepInhibitor> awake_;
  std::vector<preparation::InterruptedJob> interrupted_;

  session::JogLease jog_;
  std::string jog_client_;
  session::OverridePursuit overrides_;

  std::unique_ptr<io::SessionHost> host_;
  /// What comes back from the pool finds out with it whether the station is still there.
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace kerf::daemon
