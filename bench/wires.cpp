#include "wires.hpp"

#include <atomic>
#include <cstdlib>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

/// A descriptor that is closed once.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  void reset() {
    if (const int open = std::exchange(number_, -1); open >= 0) close(open);
  }
  [[nodiscard]] int get() const { return number_; }

 private:
  int number_;
};

/// The controller's end of a wire. For a pty `keeps_open` holds the other end too, until the program has ended: a read
/// fails while nobody has it open.
struct ControllerEnd {
  Descriptor wire;
  Descriptor keeps_open;
  WireEnd end;
};

ControllerEnd make_pty() {
  Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  std::string path(64, '\0');
  if (grantpt(master.get()) != 0 || unlockpt(master.get()) != 0) path.clear();
  if (ptsname_r(master.get(), path.data(), path.size()) == 0) path.resize(path.find('\0'));
  Descriptor slave(open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios raw{};
  tcgetattr(slave.get(), &raw);
  cfmakeraw(&raw);
  tcsetattr(slave.get(), TCSANOW, &raw);
  return {.wire = std::move(master), .keeps_open = std::move(slave), .end = {.kind = WireKind::Pty, .path = path}};
}

ControllerEnd make_listener() {
  Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  listen(listener.get(), 1);
  getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return {.wire = std::move(listener),
          .keeps_open = Descriptor{-1},
          .end = {.kind = WireKind::Tcp, .port = ntohs(address.sin_port)}};
}

/// The first client; -1 if none comes within ten seconds.
Descriptor accept_one(int listener) {
  constexpr int kPatienceMs = 10'000;
  pollfd readable{.fd = listener, .events = POLLIN, .revents = 0};
  if (poll(&readable, 1, kPatienceMs) <= 0) return Descriptor{-1};
  Descriptor client(accept4(listener, nullptr, nullptr, SOCK_CLOEXEC));
  const int on = 1;
  setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return client;
}

}  // namespace

std::optional<StreamRun> run_stream(WireKind kind, const IdealOptions& options, const CommandFor& command,
                                    const Meanwhile& meanwhile) {
  ControllerEnd here = kind == WireKind::Pty ? make_pty() : make_listener();
  IdealController controller(options);
  ChildProcess process(command(here.end));
  std::atomic<bool> is_over{false};
  std::thread serving([&] {
    if (kind == WireKind::Tcp) here.wire = accept_one(here.wire.get());
    controller.serve(here.wire.get());
  });
  StreamRun run;
  std::thread watching([&] {
    while (!is_over) {
      run.memory = process.memory().value_or(run.memory);
      meanwhile(controller, process);
    }
  });
  const auto took = process.wait();
  is_over = true;
  here.keeps_open.reset();
  serving.join();
  watching.join();
  run.account = controller.account();
  if (!took || run.account.job_lines == 0) return std::nullopt;
  run.took = *took;
  return run;
}

}  // namespace kerf::bench
