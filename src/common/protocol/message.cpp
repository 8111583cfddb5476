#include "common/protocol/message.hpp"

#include <array>

namespace kerf::protocol {
namespace {

// The names in the order of the variant; the table's size is the variant's.
constexpr std::array<std::string_view, std::variant_size_v<Message>> kNames{
    "Ok",
    "ErrorAnswer",
    "FileError",
    "AlarmRaised",
    "StatusReport",
    "Welcome",
    "SettingValue",
    "StartupLine",
    "StartupResult",
    "ParserState",
    "StoredOffset",
    "HomePosition",
    "ToolLengthOffset",
    "ToolLengthReference",
    "ProbeResult",
    "ToolRow",
    "ScaledAxes",
    "NamedParameter",
    "Version",
    "BuildOptions",
    "AxisNames",
    "NewOptions",
    "FirmwareName",
    "BuildRow",
    "Feedback",
    "HelpRow",
    "Echo",
    "AlarmCodeRow",
    "ErrorCodeRow",
    "SettingGroupRow",
    "SettingDefinition",
    "SettingDescription",
    "SettingTableRow",
    "FileRow",
    "Unrecognized",
};

}  // namespace

std::string_view name_of(const Message& message) {
  return kNames.at(message.index());
}

}  // namespace kerf::protocol
