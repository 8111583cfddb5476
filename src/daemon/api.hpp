#pragma once
// The API under /api/v1, and the page beside it: docs/api.md. One table of routes answers requests and writes the
// OpenAPI document. Loop's thread only.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/answers.hpp"
#include "daemon/live_clients.hpp"
#include "daemon/machine_park.hpp"
#include "io/json_schema.hpp"
#include "io/web/web_server.hpp"

namespace kerf::daemon {

/// A request whose path fits a route.
struct ApiCall {
  io::web::HttpRequest request;
  /// What stands in the place of each `{…}`, in order.
  std::vector<std::string> places;
};

/// Lines of a program, from `first` on.
struct ProgramText {
  std::uint32_t first = 0;
  std::uint32_t total = 0;
  std::vector<std::string> lines;
};
BOOST_DESCRIBE_STRUCT(ProgramText, (), (first, total, lines))

class Api final : public io::web::WebHandler {
 public:
  Api(io::WorkerPool& pool, MachinePark& park, ProgramLibrary& library, LiveClients& clients, Answers& answers)
      : pool_(pool), park_(park), library_(library), clients_(clients), answers_(answers) {}

  void on_request(io::web::HttpRequest request, io::web::Answer answer) override;
  [[nodiscard]] std::variant<std::unique_ptr<io::web::BodySink>, io::web::HttpReply> on_body(
      const io::web::HttpRequest& head) override;
  [[nodiscard]] std::variant<io::web::ChannelOpener, io::web::HttpReply> on_upgrade(
      const io::web::HttpRequest& head) override;

  /// Every route, with schemas of what goes in and out.
  [[nodiscard]] static Json openapi();

 private:
  struct Route;
  static const std::vector<Route>& routes();
  [[nodiscard]] Station* station_of(const ApiCall& call, const io::web::Answer& answer) const;

  void get_openapi(const ApiCall& call, const io::web::Answer& answer);
  void get_state(const ApiCall& call, const io::web::Answer& answer);
  void get_ports(const ApiCall& call, const io::web::Answer& answer);
  void post_machine(const ApiCall& call, const io::web::Answer& answer);
  void delete_machine(const ApiCall& call, const io::web::Answer& answer);
  void get_capabilities(const ApiCall& call, const io::web::Answer& answer);
  void get_settings(const ApiCall& call, const io::web::Answer& answer);
  void get_settings_history(const ApiCall& call, const io::web::Answer& answer);
  void post_command(const ApiCall& call, const io::web::Answer& answer);
  void get_jobs(const ApiCall& call, const io::web::Answer& answer);
  void get_text(const ApiCall& call, const io::web::Answer& answer);
  void get_toolpath(const ApiCall& call, const io::web::Answer& answer);
  void get_check(const ApiCall& call, const io::web::Answer& answer);
  void get_estimate(const ApiCall& call, const io::web::Answer& answer);
  void delete_program(const ApiCall& call, const io::web::Answer& answer);

  io::WorkerPool& pool_;
  MachinePark& park_;
  ProgramLibrary& library_;
  LiveClients& clients_;
  Answers& answers_;
};

}  // namespace kerf::daemon
