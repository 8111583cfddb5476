#pragma once
// Drives one Session over one link in real time. Belongs to the event loop's thread.

#include <functional>
#include <memory>
#include <vector>

#include "io/event_loop.hpp"
#include "io/journal_store.hpp"
#include "io/link_keeper.hpp"
#include "io/machine_url.hpp"
#include "io/settings_keeper.hpp"
#include "io/wire_log.hpp"
#include "io/words_keeper.hpp"
#include "sender/session/recorded_session.hpp"

namespace kerf::io {

class SessionHost {
 public:
  struct Callbacks {
    /// Everything that the session tells, in order. May call submit().
    std::function<void(const session::Event&)> event;
    /// The link could not be opened or is gone. The session was told, and its events came before.
    std::function<void(const TransportError&)> lost;
    /// Something about this side of the link that the operator should know, in one sentence.
    std::function<void(const std::string& sentence)> noted = {};
    /// What is written down, as it happens.
    std::function<void(const session::Record&)> recorded = {};
    /// With this, a link that is lost after it was open is opened again (link_keeper.hpp) and the handshake begins
    /// anew; it is called instead of `lost`. No line and no command waits for the new link.
    std::function<void(const TransportError&)> interrupted = {};
  };

  /// Starts to open the link at once. `options.link` is filled in from the address. The connection is recorded.
  SessionHost(EventLoop& loop, const MachineUrl& url, session::SessionOptions options, Callbacks callbacks,
              const RecordingOptions& recording = {}, WordsUse words = WordsUse::AskAgain);
  /// An open link is closed, and the log says that Kerf did it.
  ~SessionHost();
  SessionHost(const SessionHost&) = delete;
  SessionHost& operator=(const SessionHost&) = delete;

  void submit(const session::Command& command);
  [[nodiscard]] const session::Session& session() const { return session_; }
  [[nodiscard]] bool is_open() const { return is_open_; }
  /// The file in which the connection is recorded; empty if in none.
  [[nodiscard]] const std::string& log_path() const { return log_.path(); }
  [[nodiscard]] Instant now() const { return loop_.now(); }

 private:
  void on_lost(const TransportError& error);
  /// Empties the outbox, and arms the timer.
  void settle();
  void write_down();
  /// Then the journal; but the beginning of a job is on the disk, within limits, before its first line leaves.
  void write_lines(session::Outbox& outbox);
  void open_journal(const MachineUrl& url, const JournalOptions& options);

  EventLoop& loop_;
  session::RecordedSession session_;
  WireLog log_;
  /// Null where jobs are not written down.
  std::unique_ptr<JournalStore> journal_;
  Callbacks callbacks_;
  SettingsKeeper keeper_;
  WordsKeeper words_;
  Timer timer_;
  LinkKeeper link_;
  bool is_open_ = false;
  bool is_settling_ = false;
};

}  // namespace kerf::io
