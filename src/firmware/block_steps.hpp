#pragma once
// From a block of G-code to steps.

#include <expected>
#include <string>
#include <string_view>

#include "firmware/board.hpp"
#include "firmware/step.hpp"

namespace kerf::firmware {

/// Interprets `block` and appends what it asks for; without the answer. A refused block appends nothing.
std::expected<void, ErrorCode> add_block_steps(Board& board, std::string_view block, Steps& steps);

/// Appends a jog to where `words` say, those behind `$J=`; without the answer.
std::expected<void, ErrorCode> add_jog_steps(Board& board, std::string_view words, Steps& steps);

/// A block in capitals, without blanks and comments (grblHAL gc_normalize_block).
[[nodiscard]] std::string normalised_block(std::string_view block);

}  // namespace kerf::firmware
