#pragma once
// A drawing as a PNG picture.

#include <optional>
#include <string>

#include "rehearsal/drawing.hpp"

namespace kerf::apps {

/// The bytes of the file, on white paper; nothing if there is not enough memory for so large a picture.
[[nodiscard]] std::optional<std::string> to_png(const rehearsal::Drawing& drawing);

}  // namespace kerf::apps
