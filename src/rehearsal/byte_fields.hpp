#pragma once
// Numbers in bytes, little-endian, wherever this runs.

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace kerf::rehearsal {

template <typename Number>
concept ByteField = std::is_arithmetic_v<Number> && !std::same_as<Number, bool>;

template <ByteField Number>
[[nodiscard]] Number swapped_on_big_endian(Number value) {
  if constexpr (std::endian::native == std::endian::big && sizeof(Number) > 1) {
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &value, sizeof(Number));
    for (std::size_t at = 0; at < sizeof(Number) / 2; ++at) std::swap(bytes[at], bytes[sizeof(Number) - 1 - at]);
    std::memcpy(&value, bytes, sizeof(Number));
  }
  return value;
}

/// Appends fields to a text.
class FieldWriter {
 public:
  template <ByteField Number>
  FieldWriter& put(Number value) {
    value = swapped_on_big_endian(value);
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &value, sizeof(Number));
    bytes_.append(bytes, sizeof(Number));
    return *this;
  }
  FieldWriter& put(std::string_view text) {
    bytes_ += text;
    return *this;
  }
  /// Zeros up to a multiple of `size`.
  FieldWriter& align(std::size_t size) {
    bytes_.append((size - bytes_.size() % size) % size, '\0');
    return *this;
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  [[nodiscard]] std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// Takes fields off the front of a text. Behind its end everything is 0, and `is_short()` says so.
class FieldReader {
 public:
  explicit FieldReader(std::string_view bytes) : bytes_(bytes) {}

  template <ByteField Number>
  Number take() {
    Number value{};
    if (bytes_.size() - at_ < sizeof(Number)) {
      is_short_ = true;
      return value;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return swapped_on_big_endian(value);
  }
  std::string_view take_text(std::size_t size) {
    if (bytes_.size() - at_ < size) {
      is_short_ = true;
      return {};
    }
    const std::string_view text = bytes_.substr(at_, size);
    at_ += size;
    return text;
  }
  void align(std::size_t size) { static_cast<void>(take_text((size - at_ % size) % size)); }

  [[nodiscard]] bool is_short() const { return is_short_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool is_short_ = false;
};

}  // namespace kerf::rehearsal
