#include "sender/session/record_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <boost/mp11.hpp>

#include "common/base/json_text.hpp"
#include "common/base/text.hpp"

namespace kerf::session {
namespace {

namespace describe = boost::describe;
namespace mp11 = boost::mp11;
using base::JsonValue;

constexpr std::int64_t kNanosecondsASecond = 1'000'000'000;
constexpr std::size_t kSecondDecimals = 9;

/// Names of Record::what's alternatives, in their order.
constexpr std::array<std::string_view, std::variant_size_v<decltype(Record::what)>> kKinds = {
    "header", "opened", "received", "sent", "program", "command", "time", "closed"};

template <typename T>
concept DescribedStruct = describe::has_describe_members<T>::value && !std::is_union_v<T>;
template <typename T>
concept DescribedEnum = std::is_enum_v<T> && describe::has_describe_enumerators<T>::value;
template <typename T>
using Members = describe::describe_members<T, describe::mod_public>;

// Everything that a header or a command may hold. A member of another type does not compile: add how it is written.

void write(std::string& out, bool value) {
  out += value ? "true" : "false";
}
template <std::integral T>
void write(std::string& out, T value) {
  out += std::to_string(value);
}
[[maybe_unused]] void write(std::string& out, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}
void write(std::string& out, const std::string& value) {
  base::append_json_string(out, value);
}
[[maybe_unused]] void write(std::string& out, Duration value) {
  out += std::to_string(value.count());
}
template <DescribedEnum T>
void write(std::string& out, T value) {
  base::append_json_string(out, describe::enum_to_string(value, "?"));
}
template <typename T>
void write(std::string& out, const std::optional<T>& value);
template <typename T>
void write(std::string& out, const std::vector<T>& values);
template <DescribedStruct T>
void write(std::string& out, const T& value);

/// `,"name":value` for every member; without the comma behind the bracket of an object.
template <DescribedStruct T>
void write_members(std::string& out, const T& value) {
  mp11::mp_for_each<Members<T>>([&](auto member) {
    if (!out.ends_with('{')) out += ',';
    base::append_json_string(out, member.name);
    out += ':';
    write(out, value.*member.pointer);
  });
}

template <typename T>
void write(std::string& out, const std::optional<T>& value) {
  if (value) {
    write(out, *value);
  } else {
    out += "null";
  }
}

template <typename T>
void write(std::string& out, const std::vector<T>& values) {
  out += '[';
  for (const T& value : values) {
    if (!out.ends_with('[')) out += ',';
    write(out, value);
  }
  out += ']';
}

template <DescribedStruct T>
void write(std::string& out, const T& value) {
  out += '{';
  write_members(out, value);
  out += '}';
}

using Kind = JsonValue::Kind;

bool read(const JsonValue& json, bool& value) {
  value = json.truth;
  return json.kind == Kind::Bool;
}
template <std::integral T>
bool read(const JsonValue& json, T& value) {
  const auto number = base::parse_int<T>(json.text);
  value = number.value_or(T{});
  return json.kind == Kind::Number && number;
}
[[maybe_unused]] bool read(const JsonValue& json, double& value) {
  const char* const end = json.text.data() + json.text.size();
  return json.kind == Kind::Number && std::from_chars(json.text.data(), end, value).ptr == end;
}
bool read(const JsonValue& json, std::string& value) {
  value = json.text;
  return json.kind == Kind::String;
}
[[maybe_unused]] bool read(const JsonValue& json, Duration& value) {
  Duration::rep count{};
  const bool is_number = read(json, count);
  value = Duration{count};
  return is_number;
}
template <DescribedEnum T>
bool read(const JsonValue& json, T& value) {
  return json.kind == Kind::String && describe::enum_from_string(json.text.c_str(), value);
}
template <typename T>
bool read(const JsonValue& json, std::optional<T>& value);
template <typename T>
bool read(const JsonValue& json, std::vector<T>& values);
template <DescribedStruct T>
bool read(const JsonValue& json, T& value);

template <typename T>
bool read(const JsonValue& json, std::optional<T>& value) {
  if (json.kind == Kind::Null) return true;
  return read(json, value.emplace());
}

template <typename T>
bool read(const JsonValue& json, std::vector<T>& values) {
  if (json.kind != Kind::Array) return false;
  for (const JsonValue& element : json.elements) {
    if (!read(element, values.emplace_back())) return false;
  }
  return true;
}

template <DescribedStruct T>
bool read(const JsonValue& json, T& value) {
  bool is_good = json.kind == Kind::Object;
  mp11::mp_for_each<Members<T>>([&](auto member) {
    const JsonValue* const found = json.find(member.name);
    if (found != nullptr && !read(*found, value.*member.pointer)) is_good = false;
  });
  return is_good;
}

/// StartJob's program and timeline are no values: the program is a record of its own, and the timeline only shows
/// progress.
template <typename T>
void write_command(std::string& out, const T& command) {
  write_members(out, command);
}
void write_command(std::string&, const StartJob&) {}

template <typename T>
bool read_command(const JsonValue& json, T& command) {
  return read(json, command);
}
bool read_command(const JsonValue&, StartJob&) {
  return true;
}

void write_at(std::string& out, Instant at) {
  const std::int64_t count = at.time_since_epoch().count();
  const std::string fraction = std::to_string(std::abs(count % kNanosecondsASecond));
  if (count < 0) out += '-';
  out += std::to_string(std::abs(count / kNanosecondsASecond)) + '.';
  out.append(kSecondDecimals - fraction.size(), '0');
  out += fraction;
}

/// Seconds with up to nine decimals, to the nanosecond.
std::optional<Instant> read_at(const JsonValue* json) {
  if (json == nullptr || json->kind != Kind::Number) return std::nullopt;
  std::string_view text = json->text;
  const bool is_negative = text.starts_with('-');
  if (is_negative) text.remove_prefix(1);
  const std::size_t point = std::min(text.find('.'), text.size());
  const auto seconds = base::parse_int<std::int64_t>(text.substr(0, point));
  std::string decimals(text.substr(std::min(point + 1, text.size())));
  if (decimals.size() > kSecondDecimals) return std::nullopt;
  decimals.append(kSecondDecimals - decimals.size(), '0');
  const auto nanoseconds = base::parse_int<std::int64_t>(decimals);
  constexpr std::int64_t kMostSeconds = 9'000'000'000;
  if (!seconds || *seconds < 0 || *seconds > kMostSeconds || !nanoseconds || *nanoseconds < 0) return std::nullopt;
  const Duration since{*seconds * kNanosecondsASecond + *nanoseconds};
  return Instant{is_negative ? -since : since};
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
  write_at(out, record.at);
  out += ",\"kind\":";
  base::append_json_string(out, kind_of(record));
  std::visit([&out](const auto& what) { write_what(out, what); }, record.what);
  out += "}\n";
}

std::expected<Record, RecordFault> parse_record(std::string_view line) {
  const auto json = base::parse_json(line);
  if (!json || json->kind != Kind::Object) return std::unexpected(RecordFault::NotJson);
  const auto at = read_at(json->find("at"));
  const JsonValue* const kind = json->find("kind");
  if (!at || kind == nullptr || kind->kind != Kind::String) return std::unexpected(RecordFault::NotARecord);
  Read what = std::unexpected(RecordFault::UnknownKind);
  mp11::mp_for_each<mp11::mp_iota_c<kKinds.size()>>([&](auto index) {
    using What = std::variant_alternative_t<index, decltype(Record::what)>;
    if (kKinds[index] == kind->text) what = read_what(*json, std::type_identity<What>{});
  });
  if (!what) return std::unexpected(what.error());
  return Record{.at = *at, .what = *std::move(what)};
}

std::string_view kind_of(const Record& record) {
  return kKinds.at(record.what.index());
}

std::string_view name_of(const Command& command) {
  return kCommandNames.at(command.index());
}

}  // namespace kerf::session
