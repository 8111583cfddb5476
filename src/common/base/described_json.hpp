#pragma once
// Described values as the small JSON of json_text.hpp, and back: a struct is an object with its members in their order,
// an enum is its name, an absent optional is null, an instant is its seconds to the nanosecond, a duration its
// nanoseconds. What is read may lack members, which then keep their defaults, and may have more, which are passed over:
// so that what another version of Kerf wrote can be read. Included only where texts are made, because it compiles
// slowly.
//
// A member of a type that is not here does not compile: add how it is written.

#include <array>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/describe.hpp>
#include <boost/mp11.hpp>

#include "common/base/json_text.hpp"
#include "common/base/text.hpp"
#include "common/base/time.hpp"

namespace kerf::base::described {

template <typename T>
concept Struct = boost::describe::has_describe_members<T>::value && !std::is_union_v<T>;
template <typename T>
concept Enum = std::is_enum_v<T> && boost::describe::has_describe_enumerators<T>::value;
template <typename T>
using Members = boost::describe::describe_members<T, boost::describe::mod_public>;

/// Seconds with nine decimals: "1.250000000".
void write(std::string& out, Instant value);
[[nodiscard]] bool read(const JsonValue& json, Instant& value);

inline void write(std::string& out, bool value) {
  out += value ? "true" : "false";
}
template <std::integral T>
void write(std::string& out, T value) {
  out += std::to_string(value);
}
/// So many digits that the same number is read again.
inline void write(std::string& out, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}
inline void write(std::string& out, const std::string& value) {
  append_json_string(out, value);
}
inline void write(std::string& out, Duration value) {
  out += std::to_string(value.count());
}
template <Enum T>
void write(std::string& out, T value) {
  append_json_string(out, boost::describe::enum_to_string(value, "?"));
}
template <typename T>
void write(std::string& out, const std::optional<T>& value);
template <typename T>
void write(std::string& out, const std::vector<T>& values);
template <typename T>
void write(std::string& out, const std::map<std::string, T>& values);
template <Struct T>
void write(std::string& out, const T& value);

/// `,"name":value` for every member; without the comma behind the bracket of an object.
template <Struct T>
void write_members(std::string& out, const T& value) {
  boost::mp11::mp_for_each<Members<T>>([&](auto member) {
    if (!out.ends_with('{')) out += ',';
    append_json_string(out, member.name);
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

template <typename T>
void write(std::string& out, const std::map<std::string, T>& values) {
  out += '{';
  for (const auto& [name, value] : values) {
    if (!out.ends_with('{')) out += ',';
    append_json_string(out, name);
    out += ':';
    write(out, value);
  }
  out += '}';
}

template <Struct T>
void write(std::string& out, const T& value) {
  out += '{';
  write_members(out, value);
  out += '}';
}

// read() says whether the text was of the right kind; a value of which it says no is not to be used.

[[nodiscard]] inline bool read(const JsonValue& json, bool& value) {
  value = json.truth;
  return json.kind == JsonValue::Kind::Bool;
}
template <std::integral T>
[[nodiscard]] bool read(const JsonValue& json, T& value) {
  const auto number = parse_int<T>(json.text);
  value = number.value_or(T{});
  return json.kind == JsonValue::Kind::Number && number;
}
[[nodiscard]] inline bool read(const JsonValue& json, double& value) {
  const char* const end = json.text.data() + json.text.size();
  return json.kind == JsonValue::Kind::Number && std::from_chars(json.text.data(), end, value).ptr == end;
}
[[nodiscard]] inline bool read(const JsonValue& json, std::string& value) {
  value = json.text;
  return json.kind == JsonValue::Kind::String;
}
[[nodiscard]] inline bool read(const JsonValue& json, Duration& value) {
  Duration::rep count{};
  const bool is_number = read(json, count);
  value = Duration{count};
  return is_number;
}
template <Enum T>
[[nodiscard]] bool read(const JsonValue& json, T& value) {
  return json.kind == JsonValue::Kind::String && boost::describe::enum_from_string(json.text.c_str(), value);
}
template <typename T>
[[nodiscard]] bool read(const JsonValue& json, std::optional<T>& value);
template <typename T>
[[nodiscard]] bool read(const JsonValue& json, std::vector<T>& values);
template <typename T>
[[nodiscard]] bool read(const JsonValue& json, std::map<std::string, T>& values);
template <Struct T>
[[nodiscard]] bool read(const JsonValue& json, T& value);

template <typename T>
bool read(const JsonValue& json, std::optional<T>& value) {
  if (json.kind == JsonValue::Kind::Null) return true;
  return read(json, value.emplace());
}

template <typename T>
bool read(const JsonValue& json, std::vector<T>& values) {
  if (json.kind != JsonValue::Kind::Array) return false;
  for (const JsonValue& element : json.elements) {
    if (!read(element, values.emplace_back())) return false;
  }
  return true;
}

template <typename T>
bool read(const JsonValue& json, std::map<std::string, T>& values) {
  if (json.kind != JsonValue::Kind::Object) return false;
  for (std::size_t at = 0; at < json.elements.size(); ++at) {
    if (!read(json.elements[at], values[json.names[at]])) return false;
  }
  return true;
}

template <Struct T>
bool read(const JsonValue& json, T& value) {
  bool is_good = json.kind == JsonValue::Kind::Object;
  boost::mp11::mp_for_each<Members<T>>([&](auto member) {
    const JsonValue* const found = json.find(member.name);
    if (found != nullptr && !read(*found, value.*member.pointer)) is_good = false;
  });
  return is_good;
}

}  // namespace kerf::base::described
