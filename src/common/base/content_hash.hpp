#pragma once
// What tells one content from another: XXH3 with 128 bits. Fast enough for every file that is loaded, and no proof
// against somebody who forges one.

#include <string>
#include <string_view>

namespace kerf::base {

/// 32 hexadecimal digits, as `xxh128sum` prints them.
[[nodiscard]] std::string content_hash(std::string_view bytes);

}  // namespace kerf::base
