#pragma once
// The process that owns machines, put together. Loop's thread only.

#include <expected>
#include <memory>
#include <string>
#include <vector>

#include "daemon/api.hpp"

namespace kerf::daemon {

struct DaemonOptions {
  io::TcpAddress listen{.host = "127.0.0.1", .port = 8080};
  /// Where programs, journal and what was added are kept.
  std::string state_folder{};
  /// There from the beginning.
  std::vector<MachineRow> machines{};
  /// A file that is put into the library, and on every machine that has nothing loaded.
  std::string program{};
  io::RecordingOptions recording{};
};

class Daemon {
 public:
  /// One sentence where it cannot begin. `loop` lives longer.
  [[nodiscard]] static std::expected<std::unique_ptr<Daemon>, std::string> begin(io::EventLoop& loop,
                                                                                 const DaemonOptions& options);
  /// Running jobs are held, journals closed.
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  /// Feed hold to every machine that runs a job; false when there is none. The byte needs the loop to go out.
  [[nodiscard]] bool hold_jobs();

  /// Where it really listens.
  [[nodiscard]] const io::TcpAddress& address() const { return address_; }
  [[nodiscard]] std::size_t machine_count() const { return park_.stations().size(); }

 private:
  Daemon(io::EventLoop& loop, const DaemonOptions& options, std::unique_ptr<Store> store,
         std::unique_ptr<io::WorkerPool> pool, std::unique_ptr<ProgramLibrary> library);
  void load_everywhere(const std::string& program);

  // In this order: connections end before what they use.
  std::unique_ptr<Store> store_;
  std::unique_ptr<io::WorkerPool> pool_;
  std::unique_ptr<ProgramLibrary> library_;
  MachinePark park_;
  Answers answers_;
  LiveClients clients_;
  Api api_;
  io::web::WebServer server_;
  io::TcpAddress address_;
};

}  // namespace kerf::daemon
