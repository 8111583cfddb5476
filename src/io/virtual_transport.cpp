// virtual: a controller inside this process. Both directions pass through the event loop, so that nobody is called back
// inside his own call.

#include <utility>

#include "firmware/personality.hpp"
#include "firmware/virtual_controller.hpp"
#include "io/controller_host.hpp"
#include "io/transport.hpp"

namespace kerf::io {
namespace {

class VirtualTransport final : public Transport {
 public:
  VirtualTransport(EventLoop& loop, const VirtualAddress& address, LinkCallbacks callbacks)
      : loop_(loop),
        callbacks_(std::move(callbacks)),
        host_(loop, firmware::VirtualController(*address.personality), address.speed),
        alive_(std::make_shared<bool>(true)) {
    host_.on_output(
        [this](std::string_view bytes) { later([this, text = std::string(bytes)] { callbacks_.received(text); }); });
    later([this] {
      callbacks_.opened();
      host_.power_on();
    });
  }

  void write_realtime(std::string_view bytes) override { write_lines(bytes); }

  void write_lines(std::string_view bytes) override {
    later([this, text = std::string(bytes)] { host_.receive(text); });
  }

 private:
  template <typename Callback>
  void later(Callback callback) {
    loop_.post([alive = std::weak_ptr(alive_), callback = std::move(callback)] {
      if (!alive.expired()) callback();
    });
  }

  EventLoop& loop_;
  LinkCallbacks callbacks_;
  ControllerHost host_;
  std::shared_ptr<bool> alive_;
};

}  // namespace

std::unique_ptr<Transport> open_virtual(EventLoop& loop, const VirtualAddress& address, LinkCallbacks callbacks) {
  return std::make_unique<VirtualTransport>(loop, address, std::move(callbacks));
}

}  // namespace kerf::io
