// Any text is a settings file, a description of a setting and a value: nothing crashes, and only lines that a
// controller takes as one line are ever made of it.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "common/base/text.hpp"
#include "sender/machine/settings_plan.hpp"
#include "sender/machine/settings_text.hpp"

using namespace kerf;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// The first line describes a setting, as `$ES` does.
machine::SettingFact described_by(std::string_view line) {
  const auto parts = base::split(line, '|');
  const auto part = [&](std::size_t index) { return index < parts.size() ? parts[index] : std::string_view{}; };
  machine::SettingFact setting{.id = "110"};
  setting.type = base::parse_int(part(0)).value_or(-1);
  setting.format = part(1);
  setting.min = part(2);
  setting.max = part(3);
  setting.allow_null = part(4) == "1";
  setting.value = part(5);
  return setting;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(bytes), size};
  const auto end = text.find('\n');
  machine::Capabilities machine;
  machine.family = vocabulary::Firmware::GrblHal;
  machine.axes.letters = "XYZAB";
  machine.buffers.line_length = 79;
  machine.buffers.rx_usable = 127;
  machine.settings = {described_by(text.substr(0, end)), {.id = "22", .value = "0", .type = 2, .format = "a,b"}};
  const auto rest = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  const auto rules = machine::setting_rules_of(machine);
  const auto& setting = machine.settings.front();
  if (const auto value = machine::check_setting(setting, rest, rules)) {
    require(value->find_first_of("?!~\r\n") == std::string::npos && value->size() < 79);
    require(machine::check_setting(setting, *value, rules) == value);
  }
  (void)machine::explain_value(setting, rest, rules);
  (void)machine::explain_range(setting, rules);
  const auto settings = machine::parse_settings_text(rest);
  if (!settings) return 0;
  require(machine::parse_settings_text(machine::print_settings_text({}, *settings, {"any"})) == settings);
  (void)machine::plan_settings(machine, *settings);
  require(machine::differences(machine, *settings, *settings).empty());
  return 0;
}
