#pragma once
// Which names a part of a name may mean.

#include <string_view>

namespace kerf::firmware {

/// True if `pattern` occurs in `name`, in capitals or not: `^` at its start and `$` at its end tie it down, `*` stands
/// for any text (SourceRabbit/RabbitGRBL Regex.cpp).
[[nodiscard]] bool matches_pattern(std::string_view pattern, std::string_view name);

}  // namespace kerf::firmware
