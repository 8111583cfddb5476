#pragma once
// Those who watch and work over a WebSocket: docs/api.md, "Live". Loop's thread only.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "daemon/answers.hpp"
#include "daemon/machine_park.hpp"
#include "io/web/web_server.hpp"

namespace kerf::daemon {

class LiveClients {
 public:
  /// The park lives longer.
  LiveClients(MachinePark& park, Answers& answers) : park_(park), answers_(answers) {}
  LiveClients(const LiveClients&) = delete;
  LiveClients& operator=(const LiveClients&) = delete;

  /// `from`: the number up to which the client knows the state.
  [[nodiscard]] std::unique_ptr<io::web::ChannelUser> open(io::web::Channel& channel,
                                                           std::optional<std::uint64_t> from);

  void on_published(const Frame& patch);
  void on_traffic(const std::string& machine);

 private:
  class Client;
  void leave(Client& client);

  MachinePark& park_;
  Answers& answers_;
  std::set<Client*> clients_;
  std::uint64_t number_ = 0;
};

}  // namespace kerf::daemon
