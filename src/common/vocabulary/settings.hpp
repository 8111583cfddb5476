#pragma once
// The settings (`$n=value`) of the three firmwares (protocol.md 7). Names, units, formats, ranges and defaults are the
// firmware's interface; descriptions are our own words. Ids are only unique per firmware.

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/axis.hpp"
#include "common/vocabulary/codes.hpp"
#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// grblHAL's type codes as `$ES` prints them (protocol.md 5.2).
enum class SettingType : std::uint8_t {
  Bool = 0,
  Bitfield = 1,
  ExclusiveBitfield = 2,  ///< bit 0 enables the rest
  Radio = 3,
  Axes = 4,  ///< axis mask
  Integer = 5,
  Decimal = 6,
  Text = 7,
  Password = 8,  ///< read back in plain text on serial and telnet: mask it in logs
  Ipv4 = 9,
};
BOOST_DESCRIBE_ENUM(SettingType, Bool, Bitfield, ExclusiveBitfield, Radio, Axes, Integer, Decimal, Text, Password, Ipv4)

/// A limit of a setting as `$ES` prints it (`2.0`, `20`); absent if there is none. For texts it is a length. Reads like
/// a `std::optional<double>`.
class SettingLimit {
 public:
  constexpr SettingLimit() = default;
  consteval SettingLimit(const char* text) : text_{text}, value_{parse(text)} {}  // implicit, so that rows stay short

  [[nodiscard]] constexpr bool has_value() const { return !text_.empty(); }
  constexpr explicit operator bool() const { return has_value(); }
  [[nodiscard]] constexpr double operator*() const { return value_; }
  [[nodiscard]] constexpr double value() const { return value_; }
  [[nodiscard]] constexpr std::string_view text() const { return text_; }
  friend constexpr bool operator==(const SettingLimit&, const SettingLimit&) = default;

 private:
  // std::from_chars is not constexpr for doubles in g++ 12; limits are short, so digits and one point are enough.
  static consteval double parse(std::string_view text) {
    double value = 0;
    double scale = 0;
    for (const char letter : text) {
      if (letter == '-') continue;
      if (letter == '.') {
        scale = 1;
        continue;
      }
      value = value * 10 + (letter - '0');
      scale *= 10;
    }
    if (scale > 0) value /= scale;
    return text.starts_with('-') ? -value : value;
  }

  std::string_view text_;
  double value_ = 0;
};

/// One setting, or one setting an axis. In a `per_axis` row `id` is X's, axis n has `id + n`, `group` is X's group and
/// `name` follows the axis letter ("-axis maximum rate").
struct SettingRow {
  int id{};
  int group{};
  std::string_view name{};
  std::string_view unit{};
  SettingType type{};
  /// As `$ES` prints it: item names for bit fields and radios, a `#0` mask for numbers, `x(32)` for texts.
  std::string_view format{};
  SettingLimit min{};
  SettingLimit max{};
  std::string_view default_value{};  ///< as `$$` prints it; a mask over all axes is for three axes
  std::string_view description{};    ///< what it does, in our words; empty where the name says it all
  bool reboot = false;               ///< acts after a power cycle only
  bool allow_null = false;           ///< the empty text is accepted; for numbers: 0 is, below `min`
  bool per_axis = false;
  BuildOption build = BuildOption::Usual;  ///< `Usual` rows are in the reference build's `$$`
  /// As `format`, on machines with more than three axes; empty if it is the same.
  std::string_view rotary_format{};
  std::string_view path{};  ///< Rabbit's name, such as "Homing/Enable"; `id` is -1 if that is all it has
  /// In a `per_axis` row the defaults of all axes, separated by commas, where they are not the same.
  std::string_view axis_defaults{};
  friend constexpr bool operator==(const SettingRow&, const SettingRow&) = default;
};
BOOST_DESCRIBE_STRUCT(SettingRow, (),
                      (id, group, name, unit, type, format, min, max, default_value, description, reboot, allow_null,
                       per_axis, build, rotary_format, path, axis_defaults))

// Marks for rows of the tables, so that they stay one line.
[[nodiscard]] constexpr SettingRow per_axis(SettingRow row) {
  row.per_axis = true;
  return row;
}
[[nodiscard]] constexpr SettingRow needs_reboot(SettingRow row) {
  row.reboot = true;
  return row;
}
[[nodiscard]] constexpr SettingRow allows_null(SettingRow row) {
  row.allow_null = true;
  return row;
}
/// Only on machines with so many axes.
[[nodiscard]] constexpr SettingRow exists_with(BuildOption build, std::string_view default_value, SettingRow row) {
  row.build = build;
  row.default_value = default_value;
  return row;
}
[[nodiscard]] constexpr SettingRow named(std::string_view path, SettingRow row) {
  row.path = path;
  return row;
}

[[nodiscard]] constexpr SettingRow by_axis(std::string_view defaults, SettingRow row) {
  row.axis_defaults = defaults;
  return row;
}

/// A group of `$EG`.
struct SettingGroupRow {
  int id{};
  int parent{};
  std::string_view name;
  friend constexpr bool operator==(const SettingGroupRow&, const SettingGroupRow&) = default;
};
BOOST_DESCRIBE_STRUCT(SettingGroupRow, (), (id, parent, name))

[[nodiscard]] std::span<const SettingGroupRow> setting_group_rows();

/// `firmware`'s settings, sorted by id, ids unique (Rabbit's named-only ones come last). For an unknown firmware: none.
[[nodiscard]] std::span<const SettingRow> setting_rows(Firmware firmware);

/// A row, and which axis of it was asked for (0 for rows that are not `per_axis`).
struct SettingMatch {
  const SettingRow* row = nullptr;
  int axis = 0;
};

/// The setting with number `id`, on a machine with `axes` axes.
[[nodiscard]] std::optional<SettingMatch> find_setting(std::span<const SettingRow> rows, int id,
                                                       int axes = static_cast<int>(kMaxAxes));

/// The row whose number (`110`) or Rabbit name (`Homing/Enable`) is `key`, as `SettingValue::id` holds it.
[[nodiscard]] std::optional<SettingMatch> find_setting(std::span<const SettingRow> rows, std::string_view key,
                                                       int axes = static_cast<int>(kMaxAxes));

/// The name as `$ES` prints it: "X-axis maximum rate".
[[nodiscard]] std::string full_name(const SettingMatch& match);
/// The group as `$ES` prints it: an axis has its own.
[[nodiscard]] int group_of(const SettingMatch& match);
/// The format as `$ES` prints it on a machine with `axes` axes: items named after an axis it lacks ("B-Axis") go.
[[nodiscard]] std::string format_of(const SettingRow& row, int axes);
/// The unit as `$ES` prints it: `step/deg` instead of `step/mm` for an axis that turns.
[[nodiscard]] std::string unit_of(const SettingMatch& match, AxisMask rotary_axes);
/// True if a build with these options and `axes` axes has the row.
[[nodiscard]] bool is_built(const SettingRow& row, BuildSet builds, int axes);
/// The items of a bit field or radio, in order; unavailable ones are "N/A".
[[nodiscard]] std::string_view item_of(std::string_view format, int index);
/// The default of the setting as `$$` prints it; masks over all axes are for three (SettingRow::default_value).
[[nodiscard]] std::string_view default_of(const SettingMatch& match);
/// Rabbit's name: "X/MaxRate"; empty if there is none.
[[nodiscard]] std::string path_of(const SettingMatch& match);
/// Digits after the point that the firmware prints: those of the default, else of the `#0.000##` mask.
[[nodiscard]] int decimals_of(const SettingRow& row);

}  // namespace kerf::vocabulary
