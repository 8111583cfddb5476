#pragma once
// Described values as JSON: a struct is an object with its members in their order, an absent optional is left out, an
// enum is its name, an instant or duration is a number of seconds. Included only where JSON is made, because it
// compiles slowly.

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <boost/describe.hpp>
#include <boost/mp11.hpp>
#include <nlohmann/json.hpp>

#include "common/base/time.hpp"
#include "common/vocabulary/firmware.hpp"
#include "common/vocabulary/machine_state.hpp"

namespace kerf::io {

using Json = nlohmann::ordered_json;

/// One line of JSON. Bytes from a wire need not be UTF-8: what is not, becomes U+FFFD instead of an exception.
[[nodiscard]] inline std::string print(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

template <typename T>
concept DescribedStruct = boost::describe::has_describe_members<T>::value && !std::is_union_v<T>;
template <typename T>
concept DescribedEnum = std::is_enum_v<T> && boost::describe::has_describe_enumerators<T>::value;

/// Those of bases come first.
inline constexpr auto kShownMembers = boost::describe::mod_public | boost::describe::mod_inherited;

[[nodiscard]] inline Json to_json(vocabulary::MachineState state) {
  return std::string(name_of(state));
}
[[nodiscard]] inline Json to_json(vocabulary::Firmware firmware) {
  return std::string(name_of(firmware));
}
[[nodiscard]] inline Json to_json(Instant instant) {
  return base::to_seconds(instant);
}
[[nodiscard]] inline Json to_json(Duration duration) {
  return base::to_seconds(duration);
}
template <typename T>
  requires std::is_arithmetic_v<T> || std::is_convertible_v<T, std::string>
[[nodiscard]] Json to_json(const T& value) {
  return value;
}
template <DescribedEnum T>
[[nodiscard]] Json to_json(T value) {
  return boost::describe::enum_to_string(value, "?");
}
template <typename T>
[[nodiscard]] Json to_json(const std::vector<T>& values);
template <typename T>
[[nodiscard]] Json to_json(const std::map<std::string, T>& values);
template <typename T>
[[nodiscard]] Json to_json(const std::optional<T>& value);
template <typename... T>
[[nodiscard]] Json to_json(const std::variant<T...>& value);

template <DescribedStruct T>
[[nodiscard]] Json to_json(const T& value) {
  Json object = Json::object();
  using Members = boost::describe::describe_members<T, kShownMembers>;
  boost::mp11::mp_for_each<Members>([&](auto member) {
    Json json = to_json(value.*member.pointer);
    if (!json.is_null()) object[member.name] = std::move(json);
  });
  return object;
}

template <typename T>
Json to_json(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(to_json(value));
  return array;
}

template <typename T>
Json to_json(const std::map<std::string, T>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = to_json(value);
  return object;
}

template <typename T>
Json to_json(const std::optional<T>& value) {
  return value ? to_json(*value) : Json(nullptr);
}

template <typename... T>
Json to_json(const std::variant<T...>& value) {
  return std::visit([](const auto& alternative) { return to_json(alternative); }, value);
}

}  // namespace kerf::io
