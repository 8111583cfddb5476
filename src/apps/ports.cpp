#include "io/ports.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/commands.hpp"
#include "apps/output.hpp"
#include "common/vocabulary/dialect.hpp"
#include "io/json.hpp"

namespace kerf::apps {

/// An address that somebody has to fill in, or a machine that is always there.
struct Candidate {
  std::string url;
  std::string description;
};
BOOST_DESCRIBE_STRUCT(Candidate, (), (url, description))

struct PortList {
  std::vector<io::SerialPort> serial;
  std::vector<Candidate> network;
  std::vector<Candidate> virtual_machines;
};
BOOST_DESCRIBE_STRUCT(PortList, (), (serial, network, virtual_machines))

namespace {

PortList find_ports() {
  PortList list{.serial = io::list_serial_ports(), .network = {}, .virtual_machines = {}};
  for (const vocabulary::Dialect* dialect : vocabulary::all_dialects()) {
    if (dialect->ports.telnet != 0) {
      list.network.push_back({.url = fmt::format("tcp://ADDRESS:{}", dialect->ports.telnet),
                              .description = fmt::format("{} on the network, at its usual port", dialect->name)});
    }
    list.virtual_machines.push_back(
        {.url = fmt::format("virtual:{}", dialect->key), .description = fmt::format("{} inside Kerf", dialect->name)});
  }
  return list;
}

std::string description_of(const io::SerialPort& port) {
  std::string text = port.maker;
  if (!port.name.empty()) text += (text.empty() ? "" : " ") + port.name;
  if (text.empty()) text = port.vendor.empty() ? "built-in serial port" : "USB serial port";
  if (!port.vendor.empty()) text += fmt::format(" ({}:{})", port.vendor, port.product);
  if (!port.serial_number.empty()) text += ", serial number " + port.serial_number;
  return text;
}

void print_row(std::string_view url, std::string_view description) {
  put("  {:<28} {}\n", url, description);
}

}  // namespace

ExitStatus list_ports(const PortsOptions& options) {
  const PortList list = find_ports();
  if (options.json) {
    put("{}\n", io::print(io::to_json(list), 2));
    return ExitStatus::Done;
  }
  put("Serial ports\n");
  for (const io::SerialPort& port : list.serial) {
    print_row(port.path, description_of(port));
    if (!port.by_id.empty()) print_row("", "always " + port.by_id);
  }
  if (list.serial.empty()) put("  none: plug the machine in, switch it on and look again\n");
  put("\nNetwork\n");
  for (const Candidate& candidate : list.network) print_row(candidate.url, candidate.description);
  put("\nVirtual machines, always there\n");
  for (const Candidate& candidate : list.virtual_machines) print_row(candidate.url, candidate.description);
  put("\nAny of these is what --machine takes, for example: kerf info --machine virtual:grblhal\n");
  return ExitStatus::Done;
}

}  // namespace kerf::apps
