#include "sender/session/record_text.hpp"

#include <array>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include <boost/mp11.hpp>

#include "common/base/described_json.hpp"
#include "common/base/json_text.hpp"

namespace kerf::session {
namespace {

namespace mp11 = boost::mp11;
using base::JsonValue;
using base::described::read;
using base::described::write;
using base::described::write_members;
using Kind = JsonValue::Kind;

/// Names of Record::what's alternatives, in their order.
constexpr std::array<std::string_view, std::variant_size_v<decltype(Record::what)>> kKinds = {
    "header", "opened", "received", "sent", "program", "command", "time", "closed"};

/// StartJob's program and timeline are no values: the program is a record of its own, and the timeline only shows
/// progress.
template <typename T>
void write_command(std::string& out, const T& command) {
  write_members(out, command);
}

template <typename T>
bool read_command(const JsonValue& json, T& command) {
  return read(json, command);
}

void write_what(std::string& out, const CommandGiven& given) {
  out += ",\"command\":";
  base::append_json_string(out, name_of(given.command));
  std::visit([&out](const auto& command) { write_command(out, command); }, given.command);
}
template <typename T>
void write_what(std::string& out, const T& what) {
  write_members(out, what);
}

using Read = std::expected<decltype(Record::what), RecordFault>;

template <typename T>
Read read_what(const JsonValue& json, std::type_identity<T>) {
  T what;
  if (!read(json, what)) return std::unexpected(RecordFault::NotARecord);
  return what;
}

Read read_what(const JsonValue& json, std::type_identity<CommandGiven>) {
  const JsonValue* const name = json.find("command");
  if (name == nullptr || name->kind != Kind::String) return std::unexpected(RecordFault::NotARecord);
  Read found = std::unexpected(RecordFault::UnknownKind);
  mp11::mp_for_each<mp11::mp_iota_c<std::variant_size_v<Command>>>([&](auto index) {
    if (kCommandNames[index] != name->text) return;
    std::variant_alternative_t<index, Command> command{};
    if (read_command(json, command)) {
      found = CommandGiven{std::move(command)};
    } else {
      found = std::unexpected(RecordFault::NotARecord);
    }
  });
  return found;
}

}  // namespace

void append_line(std::string& out, const Record& record) {
  out += "{\"at\":";
  write(out, record.at);
  out += ",\"kind\":";
  base::append_json_string(out, kind_of(record));
  std::visit([&out](const auto& what) { write_what(out, what); }, record.what);
  out += "}\n";
}

std::expected<Record, RecordFault> parse_record(std::string_view line) {
  const auto json = base::parse_json(line);
  if (!json || json->kind != Kind::Object) return std::unexpected(RecordFault::NotJson);
  const JsonValue* const at = json->find("at");
  const JsonValue* const kind = json->find("kind");
  Record record;
  if (at == nullptr || !read(*at, record.at)) return std::unexpected(RecordFault::NotARecord);
  if (kind == nullptr || kind->kind != Kind::String) return std::unexpected(RecordFault::NotARecord);
  Read what = std::unexpected(RecordFault::UnknownKind);
  mp11::mp_for_each<mp11::mp_iota_c<kKinds.size()>>([&](auto index) {
    using What = std::variant_alternative_t<index, decltype(Record::what)>;
    if (kKinds[index] == kind->text) what = read_what(*json, std::type_identity<What>{});
  });
  if (!what) return std::unexpected(what.error());
  record.what = *std::move(what);
  return record;
}

std::string_view kind_of(const Record& record) {
  return kKinds.at(record.what.index());
}

std::string_view name_of(const Command& command) {
  return kCommandNames.at(command.index());
}

}  // namespace kerf::session
