#include "daemon/command.hpp"

#include <algorithm>
#include <utility>

#include <boost/mp11.hpp>

namespace kerf::daemon {

std::expected<Command, io::JsonFault> parse_command(std::string_view name, const io::Json& members) {
  const auto found = std::ranges::find(kCommandNames, name);
  if (found == kCommandNames.end()) return io::json_fault("command", "'" + std::string(name) + "' is not known here");
  const auto index = static_cast<std::size_t>(found - kCommandNames.begin());
  return boost::mp11::mp_with_index<std::variant_size_v<Command>>(
      index, [&](auto at) -> std::expected<Command, io::JsonFault> {
        auto command = io::from_json<std::variant_alternative_t<at, Command>>(members);
        if (!command) return std::unexpected(command.error());
        return Command{*std::move(command)};
      });
}

bool is_for_safety(const Command& command) {
  return std::visit(
      []<typename Kind>(const Kind&) {
        using boost::mp11::mp_list;
        return boost::mp11::mp_contains<mp_list<Hold, Stop, Abort, SoftReset, CancelJog>, Kind>::value;
      },
      command);
}

}  // namespace kerf::daemon
