#include <cerrno>
#include <filesystem>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <pty.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/server.hpp"
#include "io/stream_link.hpp"

namespace kerf::io {

namespace asio = boost::asio;
namespace fs = std::filesystem;

namespace {

/// More than any burst of answers; without a reader the kernel's own 4 kB are full long before.
constexpr std::size_t kMostWaitingBytes = 65536;

ListenError error_of(ListenFault fault, int error_number) {
  return {.fault = fault, .system_text = boost::system::generic_category().message(error_number)};
}

std::string device_of(int descriptor) {
  std::string name(256, '\0');
  if (::ttyname_r(descriptor, name.data(), name.size()) != 0) return {};
  name.resize(name.find('\0'));
  return name;
}

}  // namespace

struct PtyServer::State {
  using Link = StreamLink<asio::posix::stream_descriptor>;

  State(EventLoop& owner, std::function<void(std::string_view)> on_bytes)
      : loop(owner), received(std::move(on_bytes)) {}

  EventLoop& loop;
  std::function<void(std::string_view)> received;
  std::shared_ptr<Link> link;
  /// Held open, or every client that closes would end the terminal.
  int client_side = -1;
  std::string path;

  void close() {
    if (link) link->close();
    link.reset();
    if (client_side >= 0) ::close(client_side);
    client_side = -1;
    if (!path.empty()) ::unlink(path.c_str());
  }
};

PtyServer::PtyServer(EventLoop& loop, std::function<void(std::string_view)> received)
    : state_(std::make_shared<State>(loop, std::move(received))) {}

PtyServer::~PtyServer() {
  state_->close();
}

std::expected<void, ListenError> PtyServer::open(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(path, ignored);
  if (fs::exists(status) && !fs::is_symlink(status)) return std::unexpected(ListenError{ListenFault::PathTaken, {}});

  termios raw{};
  ::cfmakeraw(&raw);
  raw.c_cflag |= CREAD | CLOCAL | CS8;
  ::cfsetspeed(&raw, B115200);
  raw.c_cc[VMIN] = 1;
  int controller_side = -1;
  if (::openpty(&controller_side, &state_->client_side, nullptr, &raw, nullptr) != 0) {
    return std::unexpected(error_of(ListenFault::Failed, errno));
  }
  state_->link = std::make_shared<State::Link>(
      asio::posix::stream_descriptor(state_->loop.context(), controller_side),
      State::Link::Callbacks{.received = state_->received, .lost = [](boost::system::error_code) {}});
  if (fs::is_symlink(status)) ::unlink(path.c_str());
  if (::symlink(device_of(state_->client_side).c_str(), path.c_str()) != 0) {
    return std::unexpected(error_of(ListenFault::PathRefused, errno));
  }
  state_->path = path;
  state_->link->start();
  return {};
}

void PtyServer::write(std::string_view bytes) {
  if (!state_->link) return;
  if (state_->link->waiting_bytes() + bytes.size() > kMostWaitingBytes) return;
  state_->link->write_lines(bytes);
}

std::expected<void, ListenError> PtyServer::set_cable(bool connected) {
  if (state_->path.empty() || connected == (state_->link != nullptr)) return {};
  if (connected) return open(state_->path);
  state_->close();
  return {};
}

std::string explain(const ListenError& error, std::string_view place) {
  const std::string where(place);
  switch (error.fault) {
    case ListenFault::AddressUnknown:
      return where + " is no address of this computer: use 127.0.0.1 for programs here, 0.0.0.0 for the whole network.";
    case ListenFault::AddressInUse:
      return where + " is in use by another program: choose another port, or port 0 for any free one.";
    case ListenFault::NoPermission: return "You may not listen on " + where + ": choose a port above 1023.";
    case ListenFault::PathTaken: return where + " exists already: choose another path, or delete that file.";
    case ListenFault::PathRefused:
      return where + " cannot be made (" + error.system_text + "): choose a path in a folder that you may write to.";
    case ListenFault::Failed: break;
  }
  return where + " cannot be opened (" + error.system_text + ").";
}

}  // namespace kerf::io
