#pragma once
// The machine that the options of `kerf virtual` describe, as far as its firmware can be built so.

#include <expected>
#include <string>

#include "apps/commands.hpp"
#include "firmware/equipment.hpp"
#include "firmware/personality.hpp"

namespace kerf::apps {

/// How `--pendant` asks for a pendant that only scripts play.
inline constexpr const char* kPendantOfScripts = "script";

/// `personality` with the axes, tools, ports and memory that are wanted, or a sentence about what it cannot have.
[[nodiscard]] std::expected<firmware::Personality, std::string> build_of(const VirtualOptions& options,
                                                                         const firmware::Personality& personality);
/// What is plugged into it.
[[nodiscard]] std::expected<firmware::Equipment, std::string> equipment_of(const VirtualOptions& options,
                                                                           const firmware::Personality& personality);

}  // namespace kerf::apps
