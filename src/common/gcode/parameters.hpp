#pragma once
// The parameters that programs write: #1 to #5060, and names of their own.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::gcode {

/// Numbers up to 30 and names without a leading `_` belong to the call in progress and go with it; everything else is
/// global. Nothing survives a power cycle, everything survives a reset (grblHAL core ngc_params.c).
class Parameters {
 public:
  static constexpr std::uint16_t kLastWritable = 5060;
  /// One more than the firmware means to take: its check for 30 compares with what can never be.
  static constexpr std::size_t kLongestName = 31;
  static constexpr std::size_t kDeepestCall = 10;

  [[nodiscard]] static constexpr bool is_writable(std::uint16_t id) { return id > 0 && id <= kLastWritable; }

  /// 0 for numbers that were never written.
  [[nodiscard]] float get(std::uint16_t id) const;
  void set(std::uint16_t id, float value);

  /// `name` as clean_name() gives it.
  [[nodiscard]] std::optional<float> get(std::string_view name) const;
  void set(std::string_view name, float value);

  /// `owner` tells the calls of one level apart; false if calls are nested too deeply.
  bool begin_call(int owner);
  void end_call();
  [[nodiscard]] std::size_t call_level() const { return calls_.size(); }

 private:
  /// Global parameters have owner 0.
  [[nodiscard]] int owner_of(std::uint16_t id) const;
  [[nodiscard]] int owner_of(std::string_view name) const;

  std::vector<int> calls_;
  std::map<std::pair<int, std::uint16_t>, float> numbered_;
  std::map<std::pair<int, std::string>, float, std::less<>> named_;
};

/// A name in small letters without blanks; nothing if no name remains, and cut where grblHAL stops to look.
[[nodiscard]] std::optional<std::string> clean_name(std::string_view name);

}  // namespace kerf::gcode
