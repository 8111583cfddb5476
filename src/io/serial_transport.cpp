// serial:// and pty://: both are terminals to the kernel, a pty only has no rate of its own.

#include <cerrno>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>

#include "io/ports.hpp"
#include "io/serial_line.hpp"
#include "io/stream_link.hpp"
#include "io/transport.hpp"
#include "io/usb_policy.hpp"

namespace kerf::io {
namespace {

namespace asio = boost::asio;

/// The rate that a pty is told; nothing waits for it.
constexpr int kPtyBaud = 115200;

TransportFault open_fault(int error_number) {
  switch (error_number) {
    case ENOENT: return TransportFault::NotFound;
    case EACCES:
    case EPERM: return TransportFault::NoPermission;
    case EBUSY:
    case EWOULDBLOCK: return TransportFault::Busy;
    case ENOTTY:
    case EISDIR:
    case ENOTDIR: return TransportFault::NotAPort;
    // A port whose device is gone, or /dev/ttyS* without hardware behind it.
    case EIO:
    case ENXIO:
    case ENODEV: return TransportFault::Unplugged;
    default: return TransportFault::Failed;
  }
}

TransportError error_of(int error_number) {
  return {.fault = open_fault(error_number), .system_text = boost::system::generic_category().message(error_number)};
}

class SerialTransport final : public Transport {
 public:
  SerialTransport(EventLoop& loop, const std::string& path, int baud, LinkCallbacks callbacks)
      : alive_(std::make_shared<bool>(true)) {
    asio::serial_port port(loop.context());
    const int error_number = open(port, path, baud);
    loop.post([this, alive = std::weak_ptr(alive_), error_number, callbacks] {
      if (alive.expired()) return;
      if (error_number != 0) return callbacks.lost(error_of(error_number));
      link_->start();
      callbacks.opened();
    });
    if (error_number != 0) return;
    link_ = std::make_shared<Link>(
        std::move(port),
        Link::Callbacks{.received = callbacks.received, .lost = [callbacks](boost::system::error_code fault) {
                          callbacks.lost({TransportFault::Unplugged, fault.message()});
                        }});
  }

  ~SerialTransport() override {
    if (link_) link_->close();
  }

  [[nodiscard]] machine::LinkOpening opening() const override { return opening_; }

  void write_realtime(std::string_view bytes) override {
    if (link_) link_->write_realtime(bytes);
  }

  void write_lines(std::string_view bytes) override {
    if (link_) link_->write_lines(bytes);
  }

 private:
  using Link = StreamLink<asio::serial_port>;

  int open(asio::serial_port& port, const std::string& path, int baud) {
    boost::system::error_code fault;
    port.open(path, fault);  // raw mode, not the controlling terminal
    if (fault) return fault.value();
    const int descriptor = port.native_handle();
    if (const int claimed = claim_serial_line(descriptor); claimed != 0) return claimed;
    const bool lines_fell = lets_lines_fall(descriptor);
    if (const int prepared = prepare_serial_line(descriptor, baud); prepared != 0) return prepared;
    raise_control_lines(descriptor);
    discard_serial_input(descriptor);
    if (!is_pty(descriptor)) opening_ = opening_of(find_serial_port(path), lines_fell);
    return 0;
  }

  machine::LinkOpening opening_;
  std::shared_ptr<bool> alive_;
  std::shared_ptr<Link> link_;
};

}  // namespace

std::unique_ptr<Transport> open_serial(EventLoop& loop, const SerialAddress& address, LinkCallbacks callbacks) {
  // A number that no port has stays as it is, and is not found when it is opened.
  const std::string path = serial_path(address.path, list_serial_ports()).value_or(address.path);
  return std::make_unique<SerialTransport>(loop, path, address.baud, std::move(callbacks));
}

std::unique_ptr<Transport> open_pty(EventLoop& loop, const PtyAddress& address, LinkCallbacks callbacks) {
  return std::make_unique<SerialTransport>(loop, address.path, kPtyBaud, std::move(callbacks));
}

}  // namespace kerf::io
