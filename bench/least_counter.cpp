// The least program that can do character counting: what any sender could reach on this machine. Not a sender to use:
// it knows no answer but a line that ends, and cannot stop.
//
// usage: least_counter FILE WINDOW_BYTES /dev/pts/N | least_counter FILE WINDOW_BYTES ADDRESS PORT

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <queue>
#include <string_view>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

int hold_goes_to = -1;

void hold(int) {
  static_cast<void>(!write(hold_goes_to, "!", 1));
}

int connect_to(const char* address, int port) {
  const int wire = socket(AF_INET, SOCK_STREAM, 0);
  const int on = 1;
  setsockopt(wire, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  sockaddr_in peer{};
  peer.sin_family = AF_INET;
  peer.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, address, &peer.sin_addr);
  return connect(wire, reinterpret_cast<const sockaddr*>(&peer), sizeof peer) == 0 ? wire : -1;
}

/// False when the wire broke.
bool stream(int wire, std::string_view program, std::size_t window) {
  std::queue<std::size_t> owed;
  std::size_t in_flight = 0;
  std::size_t sent = 0;
  while (sent < program.size() || !owed.empty()) {
    std::size_t end = sent;
    while (end < program.size()) {
      const std::size_t length = program.find('\n', end) + 1 - end;
      if (in_flight + length > window) break;
      owed.push(length);
      in_flight += length;
      end += length;
    }
    if (end > sent && write(wire, program.data() + sent, end - sent) != static_cast<ssize_t>(end - sent)) return false;
    sent = end;
    pollfd readable{.fd = wire, .events = POLLIN, .revents = 0};
    std::array<char, 4096> answers{};
    if (poll(&readable, 1, -1) < 0 && errno == EINTR) continue;
    const ssize_t got = read(wire, answers.data(), answers.size());
    if (got <= 0) return false;
    for (ssize_t at = 0; at < got; ++at) {
      if (answers[static_cast<std::size_t>(at)] != '\n' || owed.empty()) continue;
      in_flight -= owed.front();
      owed.pop();
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const int file = open(argv[1], O_RDONLY);
  const auto size = static_cast<std::size_t>(lseek(file, 0, SEEK_END));
  void* const text = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
  if (text == MAP_FAILED) return 1;
  const std::string_view program{static_cast<const char*>(text), size};
  const int wire = argc > 4 ? connect_to(argv[3], std::atoi(argv[4])) : open(argv[3], O_RDWR | O_NOCTTY);
  if (wire < 0 || !program.ends_with('\n')) return 1;
  hold_goes_to = wire;
  std::signal(SIGINT, hold);
  return stream(wire, program, std::strtoul(argv[2], nullptr, 10)) ? 0 : 1;
}
