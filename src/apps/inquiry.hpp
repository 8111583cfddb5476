#pragma once
// A short visit to a controller: connects, waits until it is known, and leaves it as it was.

#include <functional>
#include <optional>
#include <string>

#include "apps/exit_status.hpp"
#include "io/event_loop.hpp"
#include "io/machine_url.hpp"
#include "io/session_host.hpp"

namespace kerf::apps {

/// What a visit does once the controller is known. Runs in the event loop, which it ends by returning.
using Visit = std::function<void(const io::SessionHost&)>;

struct VisitOptions {
  /// Ask for everything that the controller enumerates.
  bool enumerate = true;
  /// A machine that is busy or under a pendant is good enough: its reports are all that is wanted.
  bool takes_busy = false;
  io::RecordingOptions recording{};
};

/// Complains where nothing was found. Interrupted by Ctrl-C.
[[nodiscard]] ExitStatus visit(const std::string& machine, const VisitOptions& options, const Visit& visit);

/// A visit that has something to do there and waits for what comes of it. Lives on the event loop's thread.
class Errand {
 public:
  Errand() = default;
  virtual ~Errand() = default;
  Errand(const Errand&) = delete;
  Errand& operator=(const Errand&) = delete;

  /// The controller is known. Gives the status to end with, or nothing to go on.
  [[nodiscard]] virtual std::optional<ExitStatus> begin(io::SessionHost& host, const io::MachineUrl& url) = 0;
  /// Everything that the session tells after that.
  [[nodiscard]] virtual std::optional<ExitStatus> on_event(io::SessionHost& host, const session::Event& event) = 0;
};

[[nodiscard]] ExitStatus run_errand(const std::string& machine, const VisitOptions& options, Errand& errand);

}  // namespace kerf::apps
