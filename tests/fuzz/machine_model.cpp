// Whatever lines come: folding never fails, unknown fields are kept, and the two positions and their offset agree.

#include "sender/machine/machine_model.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"

using namespace kerf;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const machine::Snapshot& known, const protocol::Message& message) {
  require(known.messages.size() <= machine::kMessagesKept);
  const auto* report = std::get_if<protocol::StatusReport>(&message);
  if (report == nullptr) return;
  require(known.state == report->state);
  require(known.other_fields.size() == report->unknown.size());
  const bool both_printed = report->machine_position && report->work_position;
  if (both_printed || !known.machine_position_mm || !known.work_position_mm || !known.work_offset_mm) return;
  if (known.machine_position_mm->size() != known.work_offset_mm->size()) return;
  for (std::size_t axis = 0; axis < known.work_offset_mm->size(); ++axis) {
    const double at = (*known.machine_position_mm)[axis];
    const double offset = (*known.work_offset_mm)[axis];
    const double scale = 1 + std::abs(at) + std::abs(offset);
    require(std::abs(at - offset - (*known.work_position_mm)[axis]) <= 1e-9 * scale);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  machine::MachineModel model;
  bool positions_printed_apart = false;
  for (const std::string_view line : base::split({reinterpret_cast<const char*>(bytes), size}, '\n')) {
    const protocol::Message message = protocol::decode(line);
    model.fold(Instant{}, message);
    model.on_line_accepted(line);
    const auto* report = std::get_if<protocol::StatusReport>(&message);
    // From then on they are what was printed, until one of them is printed alone.
    if (report != nullptr && (report->machine_position || report->work_position)) {
      positions_printed_apart = report->machine_position && report->work_position;
    }
    if (!positions_printed_apart) check(model.snapshot(), message);
  }
  return 0;
}
