#pragma once
// JSON as described values, for what a client sends: strict, because a misspelt member of a command to a machine must
// not be passed over. The counterpart of json.hpp.
//
// A struct is an object; members that are missing keep their defaults, unknown ones are a fault. An optional may be
// null. Numbers must be finite and fit.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/json.hpp"

namespace kerf::io {

/// Where in the text, such as "settings[2].id", and what is wrong with it.
struct JsonFault {
  std::string where;
  std::string what;
};

using JsonRead = std::expected<void, JsonFault>;

[[nodiscard]] inline std::unexpected<JsonFault> json_fault(std::string where, std::string what) {
  return std::unexpected(JsonFault{.where = std::move(where), .what = std::move(what)});
}

[[nodiscard]] inline JsonRead read_json(const Json& json, const std::string& where, bool& into) {
  if (!json.is_boolean()) return json_fault(where, "must be true or false");
  into = json.get<bool>();
  return {};
}
[[nodiscard]] inline JsonRead read_json(const Json& json, const std::string& where, std::string& into) {
  if (!json.is_string()) return json_fault(where, "must be a text");
  into = json.get<std::string>();
  return {};
}
[[nodiscard]] inline JsonRead read_json(const Json& json, const std::string& where, double& into) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) return json_fault(where, "must be a number");
  into = json.get<double>();
  return {};
}
template <typename T>
  requires std::is_integral_v<T>
[[nodiscard]] JsonRead read_json(const Json& json, const std::string& where, T& into) {
  if (!json.is_number_integer()) return json_fault(where, "must be a whole number");
  const bool is_large =
      json.is_number_unsigned() && json.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max();
  const std::int64_t value = json.get<std::int64_t>();
  if (is_large || !std::in_range<T>(value)) return json_fault(where, "is out of range");
  into = static_cast<T>(value);
  return {};
}
template <DescribedEnum T>
[[nodiscard]] JsonRead read_json(const Json& json, const std::string& where, T& into) {
  std::string names;
  bool is_known = false;
  boost::mp11::mp_for_each<boost::describe::describe_enumerators<T>>([&](auto enumerator) {
    names += std::string(names.empty() ? "" : ", ") + enumerator.name;
    if (!json.is_string() || json.get_ref<const std::string&>() != enumerator.name) return;
    into = enumerator.value;
    is_known = true;
  });
  if (!is_known) return json_fault(where, "must be one of " + names);
  return {};
}

template <typename T>
[[nodiscard]] JsonRead read_json(const Json& json, const std::string& where, std::vector<T>& into);
template <typename T>
[[nodiscard]] JsonRead read_json(const Json& json, const std::string& where, std::map<std::string, T>& into);
template <typename T>
[[nodiscard]] JsonRead read_json(const Json& json, const std::string& where, std::optional<T>& into);

template <DescribedStruct T>
[[nodiscard]] JsonRead read_json(const Json& json, const std::string& where, T& into) {
  if (!json.is_object()) return json_fault(where, "must be an object");
  const std::string prefix = where.empty() ? "" : where + ".";
  JsonRead result;
  std::size_t known = 0;
  using Members = boost::describe::describe_members<T, kShownMembers>;
  boost::mp11::mp_for_each<Members>([&](auto member) {
    const auto found = json.find(member.name);
    if (!result || found == json.end()) return;
    ++known;
    result = read_json(*found, prefix + member.name, into.*member.pointer);
  });
  if (!result || known == json.size()) return result;
  for (const auto& [name, value] : json.items()) {
    bool is_known = false;
    boost::mp11::mp_for_each<Members>([&](auto member) { is_known = is_known || name == member.name; });
    if (!is_known) return json_fault(prefix + name, "is not known here");
  }
  return result;
}

template <typename T>
JsonRead read_json(const Json& json, const std::string& where, std::vector<T>& into) {
  if (!json.is_array()) return json_fault(where, "must be a list");
  into.clear();
  for (const Json& element : json) {
    T value{};
    auto read = read_json(element, where + "[" + std::to_string(into.size()) + "]", value);
    if (!read) return read;
    into.push_back(std::move(value));
  }
  return {};
}

template <typename T>
JsonRead read_json(const Json& json, const std::string& where, std::map<std::string, T>& into) {
  if (!json.is_object()) return json_fault(where, "must be an object");
  into.clear();
  for (const auto& [name, element] : json.items()) {
    T value{};
    auto read = read_json(element, where + "." + name, value);
    if (!read) return read;
    into.emplace(name, std::move(value));
  }
  return {};
}

template <typename T>
JsonRead read_json(const Json& json, const std::string& where, std::optional<T>& into) {
  into.reset();
  if (json.is_null()) return {};
  T value{};
  auto read = read_json(json, where, value);
  if (read) into = std::move(value);
  return read;
}

/// A T from JSON that was parsed.
template <typename T>
[[nodiscard]] std::expected<T, JsonFault> from_json(const Json& json) {
  T value{};
  auto read = read_json(json, "", value);
  if (!read) return std::unexpected(read.error());
  return value;
}

}  // namespace kerf::io
