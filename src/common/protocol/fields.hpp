#pragma once
// Small readers that decode.cpp and status.cpp share.

#include <optional>
#include <string_view>
#include <vector>

namespace kerf::protocol {

/// What stands between `prefix` and `suffix`; nothing if `line` has not both.
[[nodiscard]] std::optional<std::string_view> between(std::string_view line, std::string_view prefix,
                                                      std::string_view suffix);

/// `0.000,-1.5,2`: finite numbers, at least one.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(std::string_view text);

/// `0` or `1`.
[[nodiscard]] std::optional<bool> flag_of(std::string_view text);

}  // namespace kerf::protocol
