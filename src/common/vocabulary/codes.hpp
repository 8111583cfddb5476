#pragma once
// What a row of the error and alarm tables looks like.

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include <boost/describe.hpp>

#include "common/vocabulary/firmware.hpp"

namespace kerf::vocabulary {

/// The build that has a word. `Usual` is what the reference build of each firmware has; grblHAL lists a code in `$EE`
/// only if it was compiled in.
enum class BuildOption : std::uint8_t {
  Usual,
  Expressions,
  CutterCompensation,
  FileSystem,
  Bluetooth,
  Driver,    ///< depends on the board's driver or a plugin
  FourAxes,  ///< machines with four axes or more
  FiveAxes,
  SixAxes,
  Network,  ///< boards with WiFi
};
BOOST_DESCRIBE_ENUM(BuildOption, Usual, Expressions, CutterCompensation, FileSystem, Bluetooth, Driver, FourAxes,
                    FiveAxes, SixAxes, Network)

/// What was compiled into one build.
class BuildSet {
 public:
  constexpr BuildSet(std::initializer_list<BuildOption> options) {
    for (const BuildOption option : options) bits_ |= 1U << static_cast<unsigned>(option);
  }
  [[nodiscard]] constexpr bool contains(BuildOption option) const {
    return ((bits_ >> static_cast<unsigned>(option)) & 1U) != 0;
  }

 private:
  unsigned bits_ = 0;
};

/// One error or alarm of one firmware, in our own words. `title` fits a headline (no full stop); `text` says the cause
/// and what to do. Neither contains `|`, `]` or `"`, so the virtual controllers can print them in enumerations.
struct CodeRow {
  int code{};
  std::string_view title;
  std::string_view text;
  FirmwareSet known_to{};
  bool critical = false;  ///< alarms: only a reset helps
  BuildOption build = BuildOption::Usual;
  friend constexpr bool operator==(const CodeRow&, const CodeRow&) = default;
};
BOOST_DESCRIBE_STRUCT(CodeRow, (), (code, title, text, known_to, critical, build))

/// The row with `code` in one firmware's table (sorted by code).
[[nodiscard]] const CodeRow* find_code(std::span<const CodeRow> rows, int code);

}  // namespace kerf::vocabulary
