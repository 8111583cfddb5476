#pragma once
// What tells one content from another: XXH3 with 128 bits. Fast enough for every file that is loaded, and no proof
// against somebody who forges one.

#include <memory>
#include <string>
#include <string_view>

namespace kerf::base {

/// 32 hexadecimal digits, as `xxh128sum` prints them.
[[nodiscard]] std::string content_hash(std::string_view bytes);

/// The same for a content that comes piece by piece.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(ContentHash&&) noexcept;
  ContentHash& operator=(ContentHash&&) noexcept;

  void add(std::string_view piece);
  /// Of everything that was added so far.
  [[nodiscard]] std::string digits() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kerf::base
