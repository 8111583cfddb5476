// Any text as a program, checked for any firmware: it ends, and what it finds stays small.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "rehearsal/check.hpp"

namespace {

using namespace kerf;

rehearsal::CheckMachine machine_for(std::uint8_t choice) {
  const auto all = firmware::all_personalities();
  simulation::CaseMachine machine{.personality = *all[choice % all.size()]};
  machine.stored.initialised = true;
  constexpr unsigned kLimits = 0x40;
  constexpr unsigned kZero = 0x80;
  if ((choice & kLimits) != 0) machine.stored.settings = {{"22", "1"}, {"20", "1"}, {"130", "400"}, {"131", "300"}};
  rehearsal::CheckPlace place;
  if ((choice & kZero) != 0) place.zero_mm = {-200, -150, -40};
  return rehearsal::check_machine_of(machine, place);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  const auto program = job::Program::load("fuzz.nc", std::string(bytes + 1, bytes + size));
  if (!program) return 0;
  const rehearsal::CheckResult result = rehearsal::check_program(**program, machine_for(bytes[0]));
  constexpr std::size_t kMostGroups = 200;
  if (result.groups.size() > kMostGroups) std::abort();
  for (const auto& group : result.groups) {
    if (group.first.empty() || group.first.size() > rehearsal::Findings::kKept) std::abort();
  }
  return 0;
}
