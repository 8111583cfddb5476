#pragma once
// Startup lines: the controller runs them after power-up, a reset and homing. Kept and restored with the settings, as
// "N0" and "N1".

#include <string>
#include <string_view>

namespace kerf::machine {

/// "N0": the id of a startup line among the settings.
[[nodiscard]] bool is_startup_line(std::string_view id);

/// What `block` does to the machine when it runs, such as "moves the axes"; empty when it only sets modes. Doubt counts
/// as motion.
[[nodiscard]] std::string deed_of_startup_line(std::string_view block);

/// The line as firmware keeps it: without blanks and comments, in capitals (gnea/grbl protocol.c).
[[nodiscard]] std::string stored_form_of(std::string_view block);

}  // namespace kerf::machine
