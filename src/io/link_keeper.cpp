#include "io/link_keeper.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <variant>

#include "io/ports.hpp"

namespace kerf::io {
namespace {

using namespace std::chrono_literals;

constexpr Duration kFirstWait = 250ms;
constexpr Duration kMostWaitHere = 1s;
constexpr Duration kMostWaitNetwork = 10s;
constexpr int kMostDoublings = 8;

bool is_network(const MachineUrl& url) {
  return std::holds_alternative<TcpAddress>(url) || std::holds_alternative<WebSocketAddress>(url);
}

}  // namespace

Duration wait_before(int attempt, bool network) {
  const Duration wait = kFirstWait * (1 << std::clamp(attempt, 0, kMostDoublings));
  return std::min(wait, network ? kMostWaitNetwork : kMostWaitHere);
}

LinkKeeper::LinkKeeper(EventLoop& loop, MachineUrl url, Persistence persistence, LinkCallbacks callbacks)
    : loop_(loop), url_(std::move(url)), persistence_(persistence), callbacks_(std::move(callbacks)), again_(loop) {
  open();
}

void LinkKeeper::open() {
  transport_ = open_transport(loop_, url_,
                              {.opened = [this] { on_opened(); },
                               .received =
                                   [this](std::string_view bytes) {
                                     attempt_ = 0;  // only now: a peer may take the connection to close it at once
                                     callbacks_.received(bytes);
                                   },
                               .lost = [this](const TransportError& error) { on_lost(error); }});
}

void LinkKeeper::on_opened() {
  is_open_ = true;
  is_trying_ = false;
  again_.disarm();
  ports_.reset();
  // Its name may belong to another device next time.
  if (auto* serial = std::get_if<SerialAddress>(&url_)) serial->path = lasting_name(serial->path, list_serial_ports());
  callbacks_.opened();
}

void LinkKeeper::on_lost(const TransportError& error) {
  const bool was_open = std::exchange(is_open_, false);
  if (!was_open && !is_trying_) return callbacks_.lost(error);
  if (persistence_ == Persistence::Again) try_later();
  if (was_open) callbacks_.lost(error);
}

void LinkKeeper::try_later() {
  is_trying_ = true;
  again_.arm(loop_.now() + wait_before(attempt_++, is_network(url_)), [this] { open(); });
  if (ports_ || !std::holds_alternative<SerialAddress>(url_)) return;
  ports_.emplace(loop_, [this] { again_.arm(loop_.now(), [this] { open(); }); });
}

}  // namespace kerf::io
