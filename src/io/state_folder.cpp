#include "io/state_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace kerf::io {

std::string state_folder() {
  namespace fs = std::filesystem;
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  fs::path folder = variable("XDG_STATE_HOME");
  if (folder.empty()) {
    if (variable("HOME").empty()) return {};
    folder = fs::path(variable("HOME")) / ".local" / "state";
  }
  folder /= "kerf";
  std::error_code fault;
  fs::create_directories(folder, fault);
  return fault ? std::string() : folder.string();
}

}  // namespace kerf::io
