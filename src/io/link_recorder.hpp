#pragma once
// Writes down a link that no session drives: one that Kerf only listens to, or on which it holds a recorded talk.
// Loop's thread only.

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "io/event_loop.hpp"
#include "io/transport.hpp"
#include "io/wire_log.hpp"
#include "sender/session/password_mask.hpp"
#include "sender/session/record.hpp"

namespace kerf::io {

/// What the log says of a link that a transport has lost.
[[nodiscard]] session::LinkLoss loss_of(TransportFault fault);

/// One connection, from `opened` to `gone`. Passwords do not get into the log.
class LinkRecorder {
 public:
  struct Callbacks {
    /// What is written down, as it happens.
    std::function<void(const session::Record&)> recorded = {};
    /// Why it is not written down (any more), in one sentence.
    std::function<void(const std::string& sentence)> noted = {};
  };

  LinkRecorder(EventLoop& loop, const RecordingOptions& options, session::LogHeader header, Callbacks callbacks);
  /// An open link is one that Kerf closes now.
  ~LinkRecorder();
  LinkRecorder(const LinkRecorder&) = delete;
  LinkRecorder& operator=(const LinkRecorder&) = delete;

  void opened();
  void received(std::string_view bytes);
  void sent(std::string_view bytes);
  void gone(session::LinkLoss loss);
  [[nodiscard]] const std::string& path() const { return log_.path(); }

 private:
  template <typename What>
  void write(What what);

  EventLoop& loop_;
  WireLog log_;
  Callbacks callbacks_;
  session::PasswordMask mask_;
  session::StreamMask received_;
  session::StreamMask sent_;
  bool is_open_ = false;
};

}  // namespace kerf::io
