#pragma once
// One controller of `kerf virtual`, with everything through which it can be reached.

#include <cstdio>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/rig.hpp"
#include "firmware/virtual_controller.hpp"
#include "io/controller_host.hpp"
#include "io/event_loop.hpp"
#include "io/machine_url.hpp"
#include "io/server.hpp"

namespace kerf::apps {

/// What happened to the machines, as JSON, one object a line: {"at":1.5,"machine":1,"kind":"Fault","what":"…"}.
class EventLog {
 public:
  EventLog() = default;
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  /// Into a new file, or to standard error for "-". The system's words if that fails.
  [[nodiscard]] std::expected<void, std::string> open(const std::string& file);
  /// Nothing before open().
  void write(std::size_t machine, const firmware::RigRecord& record);

 private:
  std::FILE* file_ = nullptr;
};

/// Where a machine serves, how fast its clock runs and what it remembers.
struct MachineSetup {
  std::size_t number = 1;
  /// In front of what is said about it; empty when it is the only one.
  std::string label;
  io::Speed speed;
  std::optional<io::ServeAddress> address;
  std::string pty;
  /// An address to listen at, or a `pty:` with the name of a terminal; empty: none.
  std::string pendant;
  /// A network client is greeted, where the firmware does so.
  bool greets = false;
  std::string state_file;
};

/// A place where one wire of the controller can be reached: a TCP port, a pseudo-terminal, or both.
class WireServer {
 public:
  struct Callbacks {
    std::function<void(std::string_view bytes)> received;
    /// Somebody came or went, as a sentence.
    std::function<void(std::string sentence)> told;
    /// A network client came.
    std::function<void()> connected;
    std::function<std::size_t()> room;
  };

  /// `who` is a "sender" or a "pendant".
  WireServer(io::EventLoop& loop, std::string_view who, Callbacks callbacks);

  /// The place, or what went wrong.
  [[nodiscard]] std::expected<std::string, std::string> listen(const io::ServeAddress& address);
  [[nodiscard]] std::expected<std::string, std::string> open(const std::string& path);
  void write(std::string_view bytes);
  /// `greeting` goes to the network client, `notice` to the terminal beside it.
  void greet(std::string_view greeting, std::string_view notice);
  void go_on() { tcp_.go_on(); }
  /// What went wrong, or nothing.
  [[nodiscard]] std::string set_cable(bool connected);

 private:
  std::string pty_path_;
  io::TcpServer tcp_;
  io::PtyServer pty_;
};

/// Lives on the event loop's thread.
class VirtualMachine {
 public:
  VirtualMachine(io::EventLoop& loop, firmware::VirtualController controller, MachineSetup setup, EventLog& log);

  /// The places where it serves from now on, or what went wrong.
  [[nodiscard]] std::expected<std::vector<std::string>, std::string> open();
  void power_on();
  [[nodiscard]] io::ControllerHost& host() { return host_; }

 private:
  [[nodiscard]] std::expected<std::string, std::string> open_pendant();
  void say(std::string_view sentence) const;
  void note_link(std::string sentence);
  void greet();
  void set_cable(firmware::LinkState link);
  void save(const firmware::StoredState& state) const;

  const MachineSetup setup_;
  EventLog& log_;
  io::ControllerHost host_;
  WireServer sender_;
  WireServer pendant_;
};

}  // namespace kerf::apps
