#include "io/settings_archive.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/base/text.hpp"
#include "io/ports.hpp"
#include "io/state_folder.hpp"
#include "sender/machine/capability_collector.hpp"
#include "sender/machine/settings_text.hpp"

namespace kerf::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExtension = ".settings";
constexpr std::string_view kTaken = "; taken: ";
constexpr std::string_view kReason = "; reason: ";
constexpr std::string_view kMachine = "; machine: ";

/// A name that is fine for a folder anywhere.
std::string as_file_name(std::string_view text) {
  std::string name;
  for (const char letter : text) {
    const char upper = base::to_upper(letter);
    const bool is_plain = base::is_digit(letter) || (upper >= 'A' && upper <= 'Z') || letter == '.' || letter == '_';
    name += is_plain ? letter : '-';
  }
  return name;
}

std::string one_line(std::string_view text) {
  std::string line{base::trim(text)};
  std::ranges::replace_if(line, [](char letter) { return letter == '\n' || letter == '\r'; }, ' ');
  return line;
}

void read_label(std::string_view text, SettingsVersion& version) {
  for (std::string_view line : base::split(text, '\n')) {
    line = base::trim(line);
    if (!line.starts_with(';')) return;
    if (line.starts_with(kTaken)) version.taken = line.substr(kTaken.size());
    if (line.starts_with(kReason)) version.reason = line.substr(kReason.size());
    if (line.starts_with(kMachine)) version.machine = line.substr(kMachine.size());
  }
}

struct NamePart {
  const machine::Capabilities& machine;

  std::string operator()(const SerialAddress& serial) const {
    std::error_code fault;
    const std::string real = fs::weakly_canonical(serial.path, fault).string();
    for (const SerialPort& port : list_serial_ports()) {
      const bool is_it = port.path == serial.path || port.path == real || port.by_id == serial.path;
      if (is_it && !port.serial_number.empty()) return "usb-" + port.vendor + "-" + port.serial_number;
    }
    return "serial-" + serial.path;
  }
  std::string operator()(const TcpAddress& tcp) const { return "tcp-" + tcp.host + "-" + std::to_string(tcp.port); }
  std::string operator()(const WebSocketAddress& ws) const { return "ws-" + ws.host + "-" + std::to_string(ws.port); }
  std::string operator()(const PtyAddress& pty) const { return "pty-" + pty.path; }
  std::string operator()(const VirtualAddress&) const { return {}; }
};

/// Which values are passwords is only known once the controller was asked for its descriptions, if it has some.
bool knows_passwords(const machine::Capabilities& machine) {
  const auto is_told = [](const machine::SettingFact& setting) { return setting.source == machine::FactSource::Told; };
  return !machine.has("ENUMS") || std::ranges::any_of(machine.settings, is_told);
}

}  // namespace

std::vector<int> SettingsArchive::numbers() const {
  std::vector<int> found;
  if (folder_.empty()) return found;
  std::error_code fault;
  for (fs::directory_iterator entry(folder_, fault), end; !fault && entry != end; entry.increment(fault)) {
    const fs::path& path = entry->path();
    if (path.extension() != kExtension) continue;
    const auto number = base::parse_int(path.stem().string());
    if (number && *number > 0) found.push_back(*number);
  }
  std::ranges::sort(found);
  return found;
}

std::string SettingsArchive::path_of(int number) const {
  return (fs::path(folder_) / fmt::format("{:04}{}", number, kExtension)).string();
}

std::optional<SettingsVersion> SettingsArchive::find(int number) const {
  if (folder_.empty()) return std::nullopt;
  SettingsVersion version{.number = number, .path = path_of(number)};
  const auto text = read_text_file(version.path);
  if (!text) return std::nullopt;
  auto settings = machine::parse_settings_text(*text);
  if (!settings) return std::nullopt;
  version.settings = *std::move(settings);
  read_label(*text, version);
  return version;
}

std::vector<SettingsVersion> SettingsArchive::versions() const {
  std::vector<SettingsVersion> found;
  for (const int number : numbers()) {
    if (auto version = find(number)) found.push_back(*std::move(version));
  }
  return found;
}

std::optional<SettingsVersion> SettingsArchive::latest() const {
  const auto all = numbers();
  for (auto number = all.rbegin(); number != all.rend(); ++number) {
    if (auto version = find(*number)) return version;
  }
  return std::nullopt;
}

std::expected<int, FileError> SettingsArchive::store(const machine::Capabilities& machine, std::string_view reason,
                                                     std::string_view taken) const {
  const auto settings = machine::settings_of(machine);
  if (folder_.empty() || settings.empty() || !knows_passwords(machine)) return 0;
  const auto before = latest();
  if (before && machine::differences(machine, before->settings, settings).empty()) return 0;
  std::error_code fault;
  fs::create_directories(folder_, fault);
  const auto all = numbers();
  const int number = all.empty() ? 1 : all.back() + 1;
  const std::vector<std::string> label{"taken: " + one_line(taken), "reason: " + one_line(reason),
                                       "machine: " + one_line(machine::summary_of(machine))};
  const auto written = replace_text_file(path_of(number), machine::print_settings_text(machine, settings, label));
  if (!written) return std::unexpected(written.error());
  return number;
}

std::string machine_identity(const MachineUrl& url, const machine::Capabilities& machine) {
  std::string place = std::visit(NamePart{machine}, url);
  if (place.empty()) return {};
  for (const machine::BuildFact& row : machine.build_rows) {
    if (row.key.ends_with("MAC") && !row.value.empty()) place = "mac-" + row.value;
  }
  const std::string_view firmware = vocabulary::dialect_of(machine.family).key;
  return as_file_name(place + "-" + std::string{firmware.empty() ? "other" : firmware});
}

SettingsArchive settings_archive_of(const MachineUrl& url, const machine::Capabilities& machine) {
  const std::string identity = machine_identity(url, machine);
  const std::string folder = identity.empty() ? std::string{} : state_folder();
  if (folder.empty()) return SettingsArchive{{}};
  return SettingsArchive{(fs::path(folder) / "machines" / identity / "settings").string()};
}

std::string wall_clock_text() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace kerf::io
