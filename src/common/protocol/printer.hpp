#pragma once
// Printing that encode.cpp and encode_status.cpp share.

#include <span>
#include <string>

#include "common/protocol/encode.hpp"

namespace kerf::protocol {

/// Appends "0.000,1.000".
void append_positions(std::string& out, std::span<const double> values, const PrintStyle& style);

/// `<...>`
[[nodiscard]] std::string encode_status(const StatusReport& report, const PrintStyle& style);

}  // namespace kerf::protocol
