#pragma once
// Drives one Session over one link in real time. Belongs to the event loop's thread.

#include <functional>
#include <memory>

#include "io/event_loop.hpp"
#include "io/machine_url.hpp"
#include "io/settings_keeper.hpp"
#include "io/transport.hpp"
#include "sender/session/session.hpp"

namespace kerf::io {

class SessionHost {
 public:
  struct Callbacks {
    /// Everything that the session tells, in order. May call submit().
    std::function<void(const session::Event&)> event;
    /// The link could not be opened or is gone. The session was told, and its events came before.
    std::function<void(const TransportError&)> lost;
  };

  /// Starts to open the link at once. `options.link` is filled in from the address.
  SessionHost(EventLoop& loop, const MachineUrl& url, session::SessionOptions options, Callbacks callbacks);

  void submit(const session::Command& command);
  [[nodiscard]] const session::Session& session() const { return session_; }
  [[nodiscard]] bool is_open() const { return is_open_; }

 private:
  void on_lost(const TransportError& error);
  /// Empties the outbox, and arms the timer.
  void settle();

  EventLoop& loop_;
  session::Session session_;
  Callbacks callbacks_;
  SettingsKeeper keeper_;
  Timer timer_;
  std::unique_ptr<Transport> transport_;
  bool is_open_ = false;
  bool is_settling_ = false;
};

}  // namespace kerf::io
