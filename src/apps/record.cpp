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
#include "io/link_recorder.hpp"
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
           const io::SessionHost::Callbacks& callbacks)
      : recorder_(loop, recording, {.machine = to_string(url), .listening = true},
                  {.recorded = callbacks.recorded, .noted = callbacks.noted}),
        transport_(io::open_transport(loop, url,
                                      {.opened = [this] { recorder_.opened(); },
                                       .received = [this](std::string_view bytes) { recorder_.received(bytes); },
                                       .lost =
                                           [this, lost = callbacks.lost](const io::TransportError& error) {
                                             recorder_.gone(io::loss_of(error.fault));
                                             lost(error);
                                           }})) {}

  [[nodiscard]] const std::string& log_path() const { return recorder_.path(); }

 private:
  io::LinkRecorder recorder_;
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
