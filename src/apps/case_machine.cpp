#include "apps/case_machine.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/text.hpp"
#include "firmware/settings_store.hpp"
#include "firmware/virtual_controller.hpp"
#include "io/machine_url.hpp"
#include "io/text_file.hpp"

namespace kerf::apps {
namespace {

using simulation::CaseMachine;
using simulation::InjectedByte;

constexpr int kHex = 16;

/// A firmware is told one line after the other, and refuses what does not fit yet: soft limits before homing. Where an
/// error stays in force until an empty line or a reset, a refused last line refuses the blocks of the case as well, and
/// settings that want a reset only act after one (grblHAL/core protocol.c, planner.c).
std::vector<std::string> keep_accepted(CaseMachine& machine, std::string_view text) {
  std::vector<std::string> refused;
  auto& kept = machine.stored.settings;
  firmware::SettingsStore store(machine.personality, firmware::axes_of(machine.personality, machine.stored));
  const bool latches = machine.personality.dialect().error_latch;
  std::string latched;
  kept.clear();
  for (const std::string_view line : base::split(text, '\n')) {
    firmware::StoredState told;
    if (!firmware::apply_settings_text(told, line)) continue;
    for (const auto& [key, value] : told.settings) {
      const bool accepted = store.write(key, value).has_value();
      latched.clear();
      if (!accepted) {
        refused.push_back(key);
        if (latches) latched = fmt::format("{}\n", base::trim(line));
      } else if (latches && store.find(key)->match.row->reboot) {
        machine.told += fmt::format("{}\n", base::trim(line));
      } else {
        kept.insert_or_assign(key, value);
      }
    }
  }
  machine.told += latched;
  // A later line may have taken them back.
  if (!store.flag(firmware::setting::kSoftLimits)) kept.erase(std::to_string(firmware::setting::kSoftLimits));
  return refused;
}

bool load_settings(CaseMachine& machine, const std::string& file) {
  machine.stored.initialised = true;
  if (file.empty()) return true;
  const auto text = io::read_text_file(file);
  if (!text) {
    complain(io::explain(text.error(), file));
    return false;
  }
  const auto applied = firmware::apply_settings_text(machine.stored, *text);
  if (!applied) {
    complain(fmt::format("{}, line {}: this is no setting; write one '$n=value' a line, such as '$110=500'.", file,
                         applied.error().line));
    return false;
  }
  if (const auto rejected = keep_accepted(machine, *text); !rejected.empty()) {
    complain(fmt::format("{}: {} refuses ${}, left out.", file, name_of(machine.personality.firmware),
                         fmt::join(rejected, ", $")));
  }
  return true;
}

/// Switches stand only where the command line puts them.
bool place_switches(CaseMachine& machine, const std::string& text) {
  const auto places = text.empty() ? std::vector<std::string_view>{} : base::split(text, ',');
  bool is_sound = places.size() <= vocabulary::kMaxAxes;
  for (std::size_t axis = 0; axis < vocabulary::kMaxAxes; ++axis) {
    std::optional<double> place_mm;
    if (axis < places.size()) {
      place_mm = base::parse_decimal(base::trim(places[axis]));
      is_sound = is_sound && place_mm.has_value();
      // A distance in the homing direction, whichever sign was written.
      if (place_mm) place_mm = std::abs(*place_mm);
    }
    machine.workcell.emplace_back(
        firmware::HomingSwitchMoved{.axis = static_cast<vocabulary::Axis>(axis), .distance_mm = place_mm});
  }
  if (!is_sound)
    complain(fmt::format("'{}' is no place for limit switches: write one number an axis, such as -5,-5,0.", text));
  return is_sound;
}

}  // namespace

std::optional<CaseMachine> load_case_machine(const CaseMachineOptions& options) {
  const auto personality = io::parse_personality(options.personality);
  if (!personality) {
    complain(io::explain(personality.error()));
    return std::nullopt;
  }
  CaseMachine machine{.personality = **personality};
  if (!load_settings(machine, options.settings_file)) return std::nullopt;
  if (!place_switches(machine, options.limit_switches)) return std::nullopt;
  if (options.probe_contact_mm) {
    machine.workcell.emplace_back(firmware::ProbeSurfaceMoved{.z_mm = options.probe_contact_mm});
  }
  return machine;
}

std::optional<InjectedByte> parse_injection(const std::string& text) {
  const auto parts = base::split_at_most(text, ':', 2);
  if (parts.size() != 2) return std::nullopt;
  const auto after_s = base::parse_decimal(base::trim(parts[0]));
  std::string_view digits = base::trim(parts[1]);
  if (base::starts_with_ignoring_case(digits, "0x")) digits.remove_prefix(2);
  const auto byte = base::parse_int<std::uint8_t>(digits, kHex);
  if (!after_s || *after_s < 0 || !byte) return std::nullopt;
  return InjectedByte{.after = base::from_seconds(*after_s), .byte = *byte};
}

std::optional<std::vector<InjectedByte>> parse_injections(const std::vector<std::string>& texts) {
  std::vector<InjectedByte> bytes;
  for (const std::string& text : texts) {
    const auto byte = parse_injection(text);
    if (!byte) {
      complain(
          fmt::format("'{}' is no injected byte: write seconds, a colon and a byte in hex, such as 1.5:0x21.", text));
      return std::nullopt;
    }
    bytes.insert(std::ranges::upper_bound(bytes, byte->after, {}, &InjectedByte::after), *byte);
  }
  return bytes;
}

std::optional<simulation::ProgramLink> parse_link(const std::string& text) {
  if (text == "saturated") return simulation::ProgramLink{};
  const auto baud = base::parse_int<int>(text);
  if (!baud || *baud <= 0) {
    complain(fmt::format("'{}' is no link: write 'saturated', or a baud rate such as 115200.", text));
    return std::nullopt;
  }
  return simulation::ProgramLink{.baud = baud};
}

}  // namespace kerf::apps
