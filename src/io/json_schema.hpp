#pragma once
// Described types as JSON Schema (draft 2020-12): what json.hpp writes. Structs become entries of `definitions`, by
// their names.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <boost/core/demangle.hpp>

#include "io/json.hpp"

namespace kerf::io {

/// What a container holds; the type itself where it is none.
template <typename T>
struct HeldIn {
  using type = T;
};
template <typename T>
struct HeldIn<std::vector<T>> {
  using type = T;
};
template <typename T>
struct HeldIn<std::optional<T>> {
  using type = T;
};
template <typename T>
struct HeldIn<std::map<std::string, T>> {
  using type = T;
};
template <typename T>
inline constexpr bool kIsOptional = std::is_same_v<T, std::optional<typename HeldIn<T>::type>>;
template <typename T>
inline constexpr bool kIsList = std::is_same_v<T, std::vector<typename HeldIn<T>::type>>;
template <typename T>
inline constexpr bool kIsMap = std::is_same_v<T, std::map<std::string, typename HeldIn<T>::type>>;

/// Collects the schemas of types; those of structs are shared.
class SchemaBook {
 public:
  /// References begin with this: "#/components/schemas/".
  explicit SchemaBook(std::string prefix) : prefix_(std::move(prefix)) {}

  /// The schema of T, or a reference to it.
  template <typename T>
  [[nodiscard]] Json of();

  /// All structs and enums that were met.
  [[nodiscard]] const std::map<std::string, Json>& definitions() const { return definitions_; }

 private:
  template <typename T>
  [[nodiscard]] static std::string name_of_type() {
    const std::string full = boost::core::demangle(typeid(T).name());
    return full.substr(full.rfind(':') + 1);
  }
  [[nodiscard]] Json reference(const std::string& name) const { return {{"$ref", prefix_ + name}}; }

  template <typename T>
  void define_struct(const std::string& name);

  std::string prefix_;
  std::map<std::string, Json> definitions_;
};

template <typename T>
Json SchemaBook::of() {
  if constexpr (kIsOptional<T>) {
    return of<typename HeldIn<T>::type>();
  } else if constexpr (kIsList<T>) {
    return {{"type", "array"}, {"items", of<typename HeldIn<T>::type>()}};
  } else if constexpr (kIsMap<T>) {
    return {{"type", "object"}, {"additionalProperties", of<typename HeldIn<T>::type>()}};
  } else if constexpr (std::is_same_v<T, bool>) {
    return {{"type", "boolean"}};
  } else if constexpr (std::is_integral_v<T>) {
    return {{"type", "integer"}};
  } else if constexpr (std::is_floating_point_v<T> || std::is_same_v<T, Instant> || std::is_same_v<T, Duration>) {
    return {{"type", "number"}};
  } else if constexpr (DescribedEnum<T>) {
    const std::string name = name_of_type<T>();
    if (!definitions_.contains(name)) {
      Json names = Json::array();
      boost::mp11::mp_for_each<boost::describe::describe_enumerators<T>>(
          [&](auto enumerator) { names.push_back(enumerator.name); });
      definitions_[name] = {{"type", "string"}, {"enum", std::move(names)}};
    }
    return reference(name);
  } else if constexpr (DescribedStruct<T>) {
    const std::string name = name_of_type<T>();
    if (!definitions_.contains(name)) define_struct<T>(name);
    return reference(name);
  } else {
    // Whatever to_json() makes a text of: names of states, of firmware.
    return {{"type", "string"}};
  }
}

template <typename T>
void SchemaBook::define_struct(const std::string& name) {
  definitions_[name] = Json::object();  // one that holds itself ends here
  Json properties = Json::object();
  Json required = Json::array();
  boost::mp11::mp_for_each<boost::describe::describe_members<T, kShownMembers>>([&](auto member) {
    using Member = std::remove_cvref_t<decltype(std::declval<T>().*member.pointer)>;
    properties[member.name] = of<Member>();
    if (!kIsOptional<Member>) required.push_back(member.name);
  });
  Json schema = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  definitions_[name] = std::move(schema);
}

}  // namespace kerf::io
