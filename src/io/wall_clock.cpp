#include "io/wall_clock.hpp"

#include <array>

#include <fmt/format.h>

#include "common/base/text.hpp"

namespace kerf::io {

WallClock wall_clock_now() {
  return std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
}

std::string to_string(WallClock moment) {
  const auto day = std::chrono::floor<std::chrono::days>(moment);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(moment - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", int{date.year()}, unsigned{date.month()},
                     unsigned{date.day()}, time.hours().count(), time.minutes().count(), time.seconds().count(),
                     time.subseconds().count());
}

std::optional<WallClock> parse_wall_clock(std::string_view text) {
  if (text.ends_with('Z')) text.remove_suffix(1);
  constexpr std::string_view kForm = "0000-00-00T00:00:00";
  if (text.size() < kForm.size()) return std::nullopt;
  for (std::size_t at = 0; at < kForm.size(); ++at) {
    const bool fits = kForm[at] == '0' ? base::is_digit(text[at]) : text[at] == kForm[at];
    if (!fits) return std::nullopt;
  }
  const auto number = [text](std::size_t at, std::size_t digits) { return *base::parse_int(text.substr(at, digits)); };
  const std::chrono::year_month_day date{std::chrono::year(number(0, 4)),
                                         std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                         std::chrono::day(static_cast<unsigned>(number(8, 2)))};
  if (!date.ok() || number(11, 2) > 23 || number(14, 2) > 59 || number(17, 2) > 60) return std::nullopt;
  WallClock moment = std::chrono::sys_days(date);
  moment +=
      std::chrono::hours(number(11, 2)) + std::chrono::minutes(number(14, 2)) + std::chrono::seconds(number(17, 2));
  const std::string_view fraction = text.substr(kForm.size());
  if (fraction.empty()) return moment;
  const auto seconds = fraction.starts_with('.') ? base::parse_decimal(fraction) : std::nullopt;
  if (!seconds) return std::nullopt;
  return moment + std::chrono::milliseconds(static_cast<int>(*seconds * 1000 + 0.5));
}

}  // namespace kerf::io
