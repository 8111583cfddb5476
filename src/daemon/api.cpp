#include "daemon/api.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/base/text.hpp"
#include "daemon/api_page.hpp"
#include "daemon/api_replies.hpp"
#include "daemon/program_upload.hpp"
#include "daemon/request_guard.hpp"
#include "io/discovery.hpp"
#include "io/journal_database.hpp"
#include "io/journal_store.hpp"
#include "io/ports.hpp"
#include "io/settings_archive.hpp"
#include "preparation/settings_json.hpp"

namespace kerf::daemon {

using io::web::Answer;
using io::web::HttpReply;
using io::web::HttpRequest;

namespace {

constexpr std::string_view kRoot = "/api/v1";
constexpr std::string_view kUpload = "/api/v1/programs";
constexpr std::string_view kLive = "/api/v1/live";

struct MachineAdded {
  std::string id;
};
BOOST_DESCRIBE_STRUCT(MachineAdded, (), (id))
struct MachineToAdd {
  std::string name;
  std::string url;
};
BOOST_DESCRIBE_STRUCT(MachineToAdd, (), (name, url))
struct StateReply {
  std::uint64_t number = 0;
  StateView state;
};
BOOST_DESCRIBE_STRUCT(StateReply, (), (number, state))

enum class PortKind { Serial, Network, Virtual };
BOOST_DESCRIBE_ENUM(PortKind, Serial, Network, Virtual)
struct PortRow {
  std::string url;
  std::string title;
  PortKind kind{};
  std::optional<std::string> in_use_by{};
};
BOOST_DESCRIBE_STRUCT(PortRow, (), (url, title, kind, in_use_by))

struct JobRow {
  std::int64_t job = 0;
  std::string program{};
  std::string started_at{};
  std::optional<std::string> ended_at{};
  /// Not while it runs.
  std::optional<job::JobOutcome> outcome{};
  std::uint32_t lines_acknowledged = 0;
  std::uint32_t lines_total = 0;
  std::string reason{};
  bool resumable = false;
  std::string program_id{};
};
BOOST_DESCRIBE_STRUCT(JobRow, (),
                      (job, program, started_at, ended_at, outcome, lines_acknowledged, lines_total, reason, resumable,
                       program_id))

HttpReply not_found(std::string sentence) {
  return error_reply(404, "NotFound", std::move(sentence));
}

/// The parts of a path: "/a/b" has two.
std::vector<std::string> parts_of(std::string_view path) {
  std::vector<std::string> parts;
  for (const std::string_view part : base::split(path.substr(std::min<std::size_t>(1, path.size())), '/')) {
    parts.emplace_back(part);
  }
  return parts;
}

std::string title_of(const io::SerialPort& port) {
  const std::string name =
      base::trim(port.maker + " " + port.name).empty() ? "Serial port" : port.maker + " " + port.name;
  return std::string(base::trim(name)) + (port.serial_number.empty() ? "" : " (" + port.serial_number + ")");
}

}  // namespace

/// `reply` and `body` write the schemas; null: nothing to say about it.
struct Api::Route {
  const char* method;
  /// Below kRoot; `{name}` stands for one part.
  const char* path;
  void (Api::*handle)(const ApiCall&, const Answer&);
  const char* summary;
  Json (*reply)(io::SchemaBook&) = nullptr;
  Json (*body)(io::SchemaBook&) = nullptr;
};

const std::vector<Api::Route>& Api::routes() {
  using io::SchemaBook;
  static const std::vector<Route> kRoutes{
      {"GET", "/openapi.json", &Api::get_openapi, "This document"},
      {"GET", "/state", &Api::get_state, "The state document, with its number",
       [](SchemaBook& book) { return book.of<StateReply>(); }},
      {"GET", "/ports", &Api::get_ports, "Where machines may be: ports, the network, virtual ones",
       [](SchemaBook& book) { return book.of<std::vector<PortRow>>(); }},
      {"POST", "/machines", &Api::post_machine, "Adds a machine, and connects to it",
       [](SchemaBook& book) { return book.of<MachineAdded>(); },
       [](SchemaBook& book) { return book.of<MachineToAdd>(); }},
      {"DELETE", "/machines/{machine}", &Api::delete_machine, "Forgets a machine that was added"},
      {"GET", "/machines/{machine}/capabilities", &Api::get_capabilities, "What the machine says that it can do",
       [](SchemaBook& book) { return book.of<machine::Capabilities>(); }},
      {"GET", "/machines/{machine}/settings", &Api::get_settings, "Its settings, with their meanings"},
      {"GET", "/machines/{machine}/settings/history", &Api::get_settings_history, "The versions that are kept of them",
       [](SchemaBook& book) { return book.of<std::vector<io::SettingsVersion>>(); }},
      {"POST", "/machines/{machine}/commands", &Api::post_command, "Has the machine do something",
       [](SchemaBook& book) { return book.of<CommandAnswer>(); }},
      {"GET", "/machines/{machine}/jobs", &Api::get_jobs, "Its jobs, the newest first",
       [](SchemaBook& book) { return book.of<std::vector<JobRow>>(); }},
      {"GET", "/programs/{program}/text", &Api::get_text, "Lines of a program: `first` (from 1) and `count`",
       [](SchemaBook& book) { return book.of<ProgramText>(); }},
      {"GET", "/programs/{program}/toolpath", &Api::get_toolpath, "Its path, as docs/toolpath_format.md has it"},
      {"GET", "/programs/{program}/check", &Api::get_check, "What `machine` would say to it"},
      {"GET", "/programs/{program}/estimate", &Api::get_estimate, "How long it takes on `machine`"},
      {"DELETE", "/programs/{program}", &Api::delete_program, "Removes it from the library"},
  };
  return kRoutes;
}

void Api::on_request(HttpRequest request, Answer answer) {
  const bool changes = request.method != "GET" && request.method != "HEAD";
  if (auto refusal = why_refused(request, changes)) return answer(*std::move(refusal));
  if (!request.path.starts_with("/api/")) return answer(page_reply(request));
  if (request.path == kUpload && request.method == "POST") {
    return answer(error_reply(400, "Empty", "Send the program as the body of the request."));
  }
  const std::vector<std::string> parts = parts_of(request.path);
  bool is_known_path = request.path == kUpload || request.path == kLive;
  for (const Route& route : routes()) {
    const std::vector<std::string> wanted = parts_of(std::string(kRoot) + route.path);
    if (wanted.size() != parts.size()) continue;
    ApiCall call;
    const bool fits = std::ranges::equal(wanted, parts, [&](const std::string& pattern, const std::string& part) {
      if (!pattern.starts_with('{')) return pattern == part;
      call.places.push_back(part);
      return !part.empty();
    });
    if (!fits) continue;
    is_known_path = true;
    if (request.method != route.method && !(request.method == "HEAD" && std::string_view(route.method) == "GET"))
      continue;
    call.request = std::move(request);
    return (this->*route.handle)(call, answer);
  }
  if (is_known_path) return answer(error_reply(405, "NotAllowed", "This cannot be done to this address."));
  answer(not_found("There is nothing at this address."));
}

std::variant<std::unique_ptr<io::web::BodySink>, HttpReply> Api::on_body(const HttpRequest& head) {
  if (auto refusal = why_refused(head, true)) return *std::move(refusal);
  if (head.path != kUpload || head.method != "POST") return std::unique_ptr<io::web::BodySink>{};
  const auto name = head.parameter("name");
  if (!name || name->empty()) return error_reply(400, "NoName", "Name the program: ?name=part.nc");
  auto incoming = library_.receive(*name);
  if (!incoming) return error_reply(507, "NoRoom", incoming.error());
  return std::make_unique<ProgramUpload>(library_, *std::move(incoming));
}

std::variant<io::web::ChannelOpener, HttpReply> Api::on_upgrade(const HttpRequest& head) {
  if (auto refusal = why_refused(head, true)) return *std::move(refusal);
  if (head.path != kLive) return not_found("There is no WebSocket at this address.");
  std::optional<std::uint64_t> from;
  if (const auto text = head.parameter("from")) from = base::parse_int<std::uint64_t>(*text);
  return io::web::ChannelOpener{[this, from](io::web::Channel& channel) { return clients_.open(channel, from); }};
}

Station* Api::station_of(const ApiCall& call, const Answer& answer) const {
  Station* const station = park_.find(call.places.front());
  if (station == nullptr) answer(not_found("There is no such machine."));
  return station;
}

void Api::get_openapi(const ApiCall&, const Answer& answer) {
  answer(json_reply(openapi()));
}

void Api::get_state(const ApiCall&, const Answer& answer) {
  const StateFeed& feed = park_.feed();
  answer(json_reply({{"number", feed.number()}, {"state", feed.state()}}));
}

void Api::get_ports(const ApiCall&, const Answer& answer) {
  pool_.run([this, answer]() -> std::function<void()> {
    std::vector<PortRow> rows;
    for (const io::SerialPort& port : io::list_serial_ports()) {
      rows.push_back({.url = port.lasting_url.empty() ? port.path : port.lasting_url, .title = title_of(port)});
    }
    constexpr Duration kListening = std::chrono::milliseconds(1500);
    if (const auto heard = io::listen_to_announcements(kListening)) {
      for (const io::NetworkMachine& machine : io::machines_among(*heard)) {
        rows.push_back({.url = machine.url, .title = machine.name + " at " + machine.host, .kind = PortKind::Network});
      }
    }
    for (const vocabulary::Dialect* dialect : vocabulary::all_dialects()) {
      rows.push_back({.url = "virtual:" + std::string(dialect->key),
                      .title = std::string(dialect->name) + " inside Kerf",
                      .kind = PortKind::Virtual});
    }
    return [this, answer, rows = std::move(rows)]() mutable {
      for (PortRow& row : rows) {
        if (std::string owner = park_.owner_of(row.url); !owner.empty()) row.in_use_by = std::move(owner);
      }
      answer(json_reply(io::to_json(rows)));
    };
  });
}

void Api::post_machine(const ApiCall& call, const Answer& answer) {
  const auto machine = io::from_json<MachineToAdd>(Json::parse(call.request.body, nullptr, false));
  if (!machine) {
    return answer(error_reply(400, "BadRequest", machine.error().where + " " + machine.error().what + "."));
  }
  const auto id = park_.add({.name = machine->name, .url = machine->url});
  if (!id) return answer(error_reply(400, "NotAdded", id.error()));
  answer(json_reply(io::to_json(MachineAdded{*id}), 201));
}

void Api::delete_machine(const ApiCall& call, const Answer& answer) {
  if (station_of(call, answer) == nullptr) return;
  const auto removed = park_.remove(call.places.front());
  answer(removed ? json_reply(Json::object()) : error_reply(409, "NotRemoved", removed.error()));
}

void Api::get_capabilities(const ApiCall& call, const Answer& answer) {
  const Station* const station = station_of(call, answer);
  if (station == nullptr) return;
  if (station->session() == nullptr) return answer(error_reply(409, "NotConnected", "The machine is not connected."));
  answer(json_reply(io::to_json(station->session()->capabilities())));
}

void Api::get_settings(const ApiCall& call, const Answer& answer) {
  const Station* const station = station_of(call, answer);
  if (station == nullptr) return;
  if (station->session() == nullptr) return answer(error_reply(409, "NotConnected", "The machine is not connected."));
  const machine::Capabilities& known = station->session()->capabilities();
  answer(json_reply(preparation::settings_json(known, known.settings)));
}

void Api::get_settings_history(const ApiCall& call, const Answer& answer) {
  const Station* const station = station_of(call, answer);
  if (station == nullptr) return;
  if (station->session() == nullptr) return answer(error_reply(409, "NotConnected", "The machine is not connected."));
  pool_.run([answer, archive = io::settings_archive_of(station->url(),
                                                       station->session()->capabilities())]() -> std::function<void()> {
    return [answer, reply = json_reply(io::to_json(archive.versions()))] { answer(reply); };
  });
}

void Api::post_command(const ApiCall& call, const Answer& answer) {
  if (station_of(call, answer) == nullptr) return;
  const CommandAnswer said = answers_.obey(call.places.front(), Json::parse(call.request.body, nullptr, false), "api");
  const int status = said.outcome == Outcome::Accepted ? 200 : said.outcome == Outcome::Refused ? 409 : 400;
  answer(json_reply(io::to_json(said), status));
}

void Api::get_jobs(const ApiCall& call, const Answer& answer) {
  const Station* const station = station_of(call, answer);
  if (station == nullptr) return;
  pool_.run([this, answer, machine = io::to_string(station->url()),
             path = io::journal_path(park_.journal())]() -> std::function<void()> {
    std::vector<JobRow> rows;
    const auto journal = io::JournalDatabase::open_to_read(path);
    const auto jobs = journal ? journal->jobs() : std::unexpected(journal.error());
    if (jobs) {
      const auto open = preparation::interrupted_jobs(*jobs);
      for (const io::JournaledJob& job : *jobs) {
        if (job.machine != machine) continue;
        const job::JobHistory& history = job.history;
        const auto* const last = history.latest();
        const bool is_open = std::ranges::any_of(open, [&](const auto& row) { return row.number == job.number; });
        rows.push_back({.job = job.number,
                        .program = history.begun.program,
                        .started_at = io::to_string(job.began),
                        .lines_acknowledged = last == nullptr ? 0 : last->line_acknowledged,
                        .lines_total = history.begun.lines,
                        .reason = history.closed ? history.closed->state.reason : "",
                        .resumable = is_open,
                        .program_id = history.begun.origin.file_hash.empty() ? history.begun.hash
                                                                             : history.begun.origin.file_hash});
        if (job.is_running) continue;
        rows.back().outcome = history.outcome();
        rows.back().ended_at = io::to_string(job.last);
      }
    }
    return [this, answer, rows = std::move(rows)]() mutable {
      for (JobRow& row : rows) {
        if (!library_.programs().contains(row.program_id)) row.program_id.clear();
      }
      answer(json_reply(io::to_json(rows)));
    };
  });
}

Json Api::openapi() {
  io::SchemaBook book("#/components/schemas/");
  Json paths = Json::object();
  const auto content = [](Json schema) { return Json{{"application/json", {{"schema", std::move(schema)}}}}; };
  const Json error = {{"description", "What was wrong"}, {"content", content(book.of<ApiErrorReply>())}};
  for (const Route& route : routes()) {
    std::string method = route.method;
    std::ranges::transform(method, method.begin(), [](char letter) { return static_cast<char>(letter | 0x20); });
    Json done = {{"description", "Done"}};
    if (route.reply != nullptr) done["content"] = content(route.reply(book));
    Json operation = {{"summary", route.summary}};
    Json parameters = Json::array();
    for (const std::string& part : parts_of(route.path)) {
      if (!part.starts_with('{')) continue;
      parameters.push_back({{"name", part.substr(1, part.size() - 2)},
                            {"in", "path"},
                            {"required", true},
                            {"schema", {{"type", "string"}}}});
    }
    if (!parameters.empty()) operation["parameters"] = std::move(parameters);
    if (route.body != nullptr) operation["requestBody"] = {{"required", true}, {"content", content(route.body(book))}};
    operation["responses"] = {{"2XX", std::move(done)}, {"4XX", error}};
    paths[std::string(kRoot) + route.path][method] = std::move(operation);
  }
  Json commands = Json::array();
  boost::mp11::mp_for_each<boost::mp11::mp_iota_c<std::variant_size_v<Command>>>([&](auto index) {
    Json schema = book.of<std::variant_alternative_t<index, Command>>();
    commands.push_back({{"title", kCommandNames.at(index)}, {"allOf", {std::move(schema)}}});
  });
  Json schemas = Json::object();
  for (const auto& [name, schema] : book.definitions()) schemas[name] = schema;
  schemas["Command"] = {{"oneOf", std::move(commands)}};
  return {{"openapi", "3.1.0"},
          {"info", {{"title", "Kerf"}, {"version", KERF_VERSION}}},
          {"paths", std::move(paths)},
          {"components", {{"schemas", std::move(schemas)}}}};
}

}  // namespace kerf::daemon
