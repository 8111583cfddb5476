#include "io/process_identity.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace kerf::io {
namespace {

std::string contents_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// "boot/pid/start"; empty when there is no such process, or only its exit status is left (a zombie).
std::string identity_of(const std::string& pid) {
  const std::string stat = contents_of("/proc/" + pid + "/stat");
  // The name in brackets may hold anything; the start is field 22, the 20th behind it (proc(5)).
  std::size_t at = stat.rfind(')');
  if (at == std::string::npos) return {};
  const bool has_ended = stat.compare(at, 3, ") Z") == 0 || stat.compare(at, 3, ") X") == 0;
  if (has_ended) return {};
  for (int field = 0; field < 20 && at != std::string::npos; ++field) at = stat.find(' ', at + 1);
  if (at == std::string::npos) return {};
  const std::string start = stat.substr(at + 1, stat.find(' ', at + 1) - at - 1);
  std::string boot = contents_of("/proc/sys/kernel/random/boot_id");
  if (boot.ends_with('\n')) boot.pop_back();
  return boot + "/" + pid + "/" + start;
}

}  // namespace

std::string process_identity() {
  // Not getpid(): in a container whose /proc is the host's, that number is another process there.
  std::error_code fault;
  return identity_of(std::filesystem::read_symlink("/proc/self", fault).string());
}

bool is_running(std::string_view identity) {
  const std::size_t from = identity.find('/') + 1;
  const std::size_t to = identity.rfind('/');
  if (from == 0 || to <= from || to == std::string_view::npos) return false;
  return identity_of(std::string(identity.substr(from, to - from))) == identity;
}

}  // namespace kerf::io
