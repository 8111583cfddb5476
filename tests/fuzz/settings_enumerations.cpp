// Whatever a controller answers to `$I+`, `$$`, `$ES`, `$EG`, `$ESH`, `$SPINDLESH` …, the same is known in the end
// however its lines were cut, and what is known stays usable.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "common/protocol/message_reader.hpp"
#include "sender/machine/capability_collector.hpp"
#include "sender/machine/setting_value.hpp"
#include "sender/machine/settings_plan.hpp"

using namespace kerf;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// One byte stands for the beginning of a row, so that small inputs get deep.
std::string widen(std::string_view text) {
  constexpr std::string_view kStarts[] = {"\n[SETTING:",
                                          "\n[SETTINGGROUP:",
                                          "\n[OPT:",
                                          "\n[NEWOPT:",
                                          "\n[AXS:",
                                          "\n[SPINDLE:",
                                          "\n$",
                                          "\n[VER:",
                                          "\n[FIRMWARE:grblHAL]\n",
                                          "\n[AUX IO:",
                                          "\nRabbit GRBL v1\n",
                                          "\n[SETTINGDESCR:"};
  std::string out;
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (code >= 0x80 && code < 0x80 + std::size(kStarts))
      out += kStarts[code - 0x80];
    else
      out += letter;
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text = widen({reinterpret_cast<const char*>(bytes), size}) + "\n";
  protocol::MessageReader whole;
  protocol::MessageReader cut;
  machine::CapabilityCollector collector;
  machine::CapabilityCollector by_byte;
  for (const auto& received : whole.read(text)) collector.fold(received.message);
  for (const char& letter : text) {
    for (const auto& received : cut.read({&letter, 1})) by_byte.fold(received.message);
  }
  const auto known = collector.capabilities(true);
  require(known == by_byte.capabilities(true));
  const auto rules = machine::setting_rules_of(known);
  for (const auto& setting : known.settings) {
    require(known.find_setting(setting.id) != nullptr);
    (void)machine::explain_range(setting, rules);
    (void)machine::explain_value(setting, setting.value.value_or(""), rules);
  }
  // What the machine has is what it has.
  require(machine::plan_settings(known, machine::settings_of(known))->steps.empty());
  require(machine::differences(known, machine::settings_of(known), machine::settings_of(known)).empty());
  return 0;
}
