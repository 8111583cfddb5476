#pragma once
// Sentences for the tables that the code itself has no use for.

#include <string_view>

#include "firmware/personality.hpp"

namespace kerf::tools {

/// What "G28.1" does; empty for a word that nobody has described.
[[nodiscard]] std::string_view text_of_word(std::string_view word);
[[nodiscard]] std::string_view text_of_command(firmware::Command command);

}  // namespace kerf::tools
