#include "outside.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <deque>
#include <fstream>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/base/text.hpp"

namespace kerf::bench {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kPort = 15'000;
/// The simulator's receive buffer has 1023 places.
constexpr std::size_t kWindow = 900;
constexpr milliseconds kPatience{60'000};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool has_only_loopback() {
  bool only = true;
  auto* const all = if_nameindex();
  if (all == nullptr) return false;
  for (auto* one = all; one->if_index != 0; ++one) only = only && std::string_view{one->if_name} == "lo";
  if_freenameindex(all);
  return only;
}

/// The simulator's process, and the pipe that keeps its standard input open.
class Simulator {
 public:
  Simulator(const std::string& program, const std::string& folder) {
    if (pipe2(input_.data(), O_CLOEXEC) != 0) return;
    process_.emplace(std::vector<std::string>{program, "-t", "0", "-p", std::to_string(kPort), "-e",
                                              folder + "/EEPROM.DAT", "-b", "/dev/null", "-s", "/dev/null"},
                     input_[0]);
  }
  ~Simulator() {
    process_.reset();
    for (const int end : input_) close(end);
  }
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

 private:
  std::array<int, 2> input_{-1, -1};
  std::optional<ChildProcess> process_;
};

/// A line-wise conversation over TCP.
class Talk {
 public:
  ~Talk() {
    if (socket_ >= 0) close(socket_);
  }
  Talk() = default;
  Talk(const Talk&) = delete;
  Talk& operator=(const Talk&) = delete;

  bool connect() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(kPort);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int attempt = 0; attempt < 100; ++attempt) {
      socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      const int on = 1;
      setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return true;
      close(socket_);
      socket_ = -1;
      std::this_thread::sleep_for(milliseconds{50});
    }
    return false;
  }

  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = write(socket_, bytes.data(), bytes.size());
      if (sent <= 0) return;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }

  /// The next line without its end; nothing after `patience`.
  std::optional<std::string> line(milliseconds patience) {
    const auto deadline = Clock::now() + patience;
    for (;;) {
      if (const std::size_t end = heard_.find('\n', read_); end != std::string::npos) {
        std::string text{base::trim(std::string_view{heard_}.substr(read_, end - read_))};
        read_ = end + 1;
        return text;
      }
      heard_.erase(0, std::exchange(read_, 0));
      const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now()).count();
      pollfd wanted{.fd = socket_, .events = POLLIN, .revents = 0};
      if (left <= 0 || poll(&wanted, 1, static_cast<int>(left)) <= 0) return std::nullopt;
      std::array<char, 4096> chunk{};
      const ssize_t got = read(socket_, chunk.data(), chunk.size());
      if (got <= 0) return std::nullopt;
      heard_.append(chunk.data(), static_cast<std::size_t>(got));
    }
  }

 private:
  int socket_ = -1;
  std::string heard_;
  std::size_t read_ = 0;
};

bool is_answer(std::string_view line) {
  return line == "ok" || line.starts_with("error:");
}

/// One line at a time, each answered before the next.
bool write_settings(Talk& talk, std::string_view settings) {
  for (const std::string_view setting : base::split(settings, '\n')) {
    if (setting.empty()) continue;
    talk.send(std::string{setting} + "\n");
    std::optional<std::string> said;
    do said = talk.line(milliseconds{5000});
    while (said && !is_answer(*said));
    if (!said) return false;
  }
  return true;
}

/// Character counting; the number of refused lines, nothing if the answers stop.
std::optional<int> stream(Talk& talk, std::string_view program) {
  std::deque<std::size_t> under_way;
  std::size_t bytes_under_way = 0;
  std::size_t sent = 0;
  int refused = 0;
  while (sent < program.size() || !under_way.empty()) {
    const std::size_t first = sent;
    while (sent < program.size()) {
      const std::size_t length = program.find('\n', sent) + 1 - sent;
      if (bytes_under_way + length > kWindow) break;
      under_way.push_back(length);
      bytes_under_way += length;
      sent += length;
    }
    talk.send(program.substr(first, sent - first));
    const auto said = talk.line(kPatience);
    if (!said) return std::nullopt;
    if (!is_answer(*said) || under_way.empty()) continue;
    if (*said != "ok") ++refused;
    bytes_under_way -= under_way.front();
    under_way.pop_front();
  }
  return refused;
}

bool wait_until_idle(Talk& talk) {
  const auto deadline = Clock::now() + kPatience;
  while (Clock::now() < deadline) {
    talk.send("?");
    while (const auto said = talk.line(milliseconds{20})) {
      if (said->starts_with("<Idle")) return true;
    }
  }
  return false;
}

}  // namespace

ScratchFiles::ScratchFiles(const std::vector<BenchProgram>& programs, std::vector<std::string>& files) {
  std::vector<std::string> written;
  for (const BenchProgram& program : programs) {
    written.push_back(folder_.path() + "/" + std::string{program.name} + ".nc");
    std::ofstream(written.back()) << program.text;
  }
  files.insert(files.begin(), written.begin(), written.end());
}

BenchProgram head_of(const BenchProgram& program, int lines) {
  std::size_t end = 0;
  for (int line = 0; line < lines && end < program.text.size(); ++line) end = program.text.find('\n', end) + 1;
  return {.name = program.name, .text = program.text.substr(0, end), .settings = program.settings};
}

std::optional<PeerTook> run_peer(const std::string& simulator, const BenchProgram& program) {
  if (!has_only_loopback()) {
    std::fputs("The simulator listens on every interface: run this in a network namespace of its own.\n", stderr);
    return std::nullopt;
  }
  const ScratchFolder folder;
  const Simulator running(simulator, folder.path());
  Talk talk;
  if (!talk.connect()) return std::nullopt;
  // It loses what comes right after its welcome.
  std::this_thread::sleep_for(milliseconds{2000});
  if (!write_settings(talk, program.settings)) return std::nullopt;
  const auto started = Clock::now();
  const auto refused = stream(talk, program.text);
  if (!refused || !wait_until_idle(talk)) return std::nullopt;
  return PeerTook{.wall_s = seconds_since(started), .refused_lines = *refused};
}

}  // namespace kerf::bench
