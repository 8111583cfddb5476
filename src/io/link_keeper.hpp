#pragma once
// A link that comes back: opened again after it was lost, ever more slowly, and at once when a port appears.
//
// It carries bytes and decides nothing about the machine. Whoever owns it is told of every loss and every opening, and
// has to ask the machine anew: nothing that was queued for the old link goes out on the new one, so no motion is
// resumed by coming back. Loop's thread only.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/time.hpp"
#include "io/event_loop.hpp"
#include "io/machine_url.hpp"
#include "io/port_watch.hpp"
#include "io/transport.hpp"

namespace kerf::io {

enum class Persistence {
  Once,   ///< what is lost stays lost
  Again,  ///< a link that was open once is opened again; one that cannot be opened in the first place is not
};

/// How long to wait before the `attempt`th time (from 0): twice as long each time, up to 1 s for what is looked up on
/// this computer and 10 s for what is asked of a network.
[[nodiscard]] Duration wait_before(int attempt, bool network);

class LinkKeeper {
 public:
  /// Starts to open the link at once. `callbacks` hears `opened` and `lost` for each link.
  LinkKeeper(EventLoop& loop, MachineUrl url, Persistence persistence, LinkCallbacks callbacks);

  /// After `lost`: the link is being opened again.
  [[nodiscard]] bool is_trying() const { return is_trying_; }
  /// The link of the moment, which may be none that is open; never null.
  [[nodiscard]] Transport& transport() { return *transport_; }

 private:
  void open();
  void try_later();
  void on_opened();
  void on_lost(const TransportError& error);

  EventLoop& loop_;
  /// Where the machine is; a USB port, once seen, is followed by its serial number.
  MachineUrl url_;
  const Persistence persistence_;
  const LinkCallbacks callbacks_;
  Timer again_;
  std::optional<PortWatch> ports_;
  int attempt_ = 0;
  bool is_open_ = false;
  bool is_trying_ = false;
  std::unique_ptr<Transport> transport_;
};

}  // namespace kerf::io
