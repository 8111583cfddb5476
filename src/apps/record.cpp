// `kerf record`: connect, watch and write down, until Ctrl-C.

#include <array>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/log_lines.hpp"
#include "apps/output.hpp"
#include "io/session_host.hpp"

namespace kerf::apps {
namespace {

/// Prints what is written down, as `kerf log show` would.
class Watcher {
 public:
  explicit Watcher(const RecordOptions& options) : options_(options) {
    if (!options.shows_reports) filter_.hidden = {"status_report", "realtime"};
  }

  void show(const session::Record& record) {
    const auto entries = lines_.read(record);
    if (options_.quiet) return;
    for (const LogEntry& entry : entries) {
      if (passes(filter_, entry)) put("{}\n", shown(entry, false));
    }
    std::fflush(stdout);
  }

 private:
  const RecordOptions& options_;
  LogLines lines_;
  LogFilter filter_;
};

/// A link of which Kerf only writes down what it hears: it sends not a byte.
class Listener {
 public:
  Listener(io::EventLoop& loop, const io::MachineUrl& url, const io::RecordingOptions& recording,
           io::SessionHost::Callbacks callbacks)
      : loop_(loop),
        callbacks_(std::move(callbacks)),
        log_(loop, recording, {.machine = to_string(url), .listening = true}),
        transport_(io::open_transport(
            loop, url,
            {.opened = [this] { write(session::LinkOpened{}); },
             .received = [this](std::string_view bytes) { write(session::BytesReceived{stream_.push(bytes, mask_)}); },
             .lost =
                 [this](const io::TransportError& error) {
                   write(session::LinkGone{session::LinkLoss::Error});
                   callbacks_.lost(error);
                 }})) {}

  [[nodiscard]] const std::string& log_path() const { return log_.path(); }

 private:
  template <typename What>
  void write(What what) {
    const session::Record record{.at = loop_.now(), .what = std::move(what)};
    log_.append(record);
    callbacks_.recorded(record);
    if (const auto fault = log_.take_fault()) callbacks_.noted(*fault);
  }

  io::EventLoop& loop_;
  io::SessionHost::Callbacks callbacks_;
  io::WireLog log_;
  session::PasswordMask mask_;
  session::StreamMask stream_;
  std::unique_ptr<io::Transport> transport_;
};

}  // namespace

ExitStatus record(const RecordOptions& options) {
  const auto url = io::parse_machine_url(options.machine);
  if (!url) {
    complain(io::explain(url.error()));
    return ExitStatus::Usage;
  }
  io::EventLoop loop;
  ExitStatus status = ExitStatus::Done;
  bool was_open = false;
  Watcher watcher(options);
  const io::SessionHost::Callbacks callbacks{
      .event =
          [&](const session::Event& event) {
            const auto* failed = std::get_if<session::HandshakeFailed>(&event);
            if (failed != nullptr && failed->failure != session::HandshakeFailure::LinkLost) complain(failed->sentence);
          },
      .lost =
          [&](const io::TransportError& error) {
            complain(io::explain(*url, error));
            status = was_open ? ExitStatus::Interrupted : ExitStatus::NoConnection;
            loop.stop();
          },
      .noted =
          [&](const std::string& sentence) {
            complain(sentence);
            status = ExitStatus::Usage;
            loop.stop();
          },
      .recorded =
          [&](const session::Record& happened) {
            was_open = true;
            watcher.show(happened);
          }};
  constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
  const io::SignalWatch signals(loop, kSignals, [&](int) { loop.stop(); });
  const auto run = [&](const auto& link) {
    loop.run();
    if (!link.log_path().empty()) put("Recorded in {}\n", link.log_path());
  };
  if (options.listens) {
    run(Listener(loop, *url, options.recording, callbacks));
  } else {
    // A machine that is only watched keeps its modal state.
    run(io::SessionHost(loop, *url, {.reset_policy = session::ResetPolicy::Never}, callbacks, options.recording));
  }
  return status;
}

}  // namespace kerf::apps
