#pragma once
// Which process wrote something, so that another one can tell whether it still lives. Any thread.

#include <string>
#include <string_view>

namespace kerf::io {

/// This process, unlike any other on this computer before or after it: boot, number, and when it began.
[[nodiscard]] std::string process_identity();

/// The process of that identity is running.
[[nodiscard]] bool is_running(std::string_view identity);

}  // namespace kerf::io
