// Threading cycles of grblHAL: G76.

#include <cmath>

#include "common/gcode/checks.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

constexpr std::size_t kX = 0;
constexpr std::size_t kZ = 2;
constexpr std::uint8_t kTaperEntry = 1;
constexpr std::uint8_t kTaperExit = 2;
constexpr std::uint8_t kTaperBoth = 3;

ErrorCode check_thread_words(const Block& block, const BlockContext& context) {
  if (block.modal.plane != Plane::ZX) return ErrorCode::IllegalPlane;
  if ((block.axis_words & ~((1U << kX) | (1U << kZ))) != 0) return ErrorCode::UnusedWords;
  if (block.words.has('R') && block.r < 1.0F) return ErrorCode::ValueOutOfRange;
  if (!block.has_axis(kZ) || !block.words.has_any("IJKP")) return ErrorCode::ValueWordMissing;
  const auto& [peak, first_depth, depth] = block.ijk;
  if (block.p < 0.0F || first_depth < 0.0F || depth < 0.0F) return ErrorCode::NegativeValue;
  const bool unknown_taper = block.words.has('L') && block.l > kTaperBoth;
  if (peak == 0.0F || first_depth == 0.0F || depth <= first_depth || unknown_taper) return ErrorCode::ValueOutOfRange;
  const float rpm = context.state.spindle_rpm;
  const bool turns_well = rpm >= context.settings.spindle_rpm_min && rpm <= context.settings.spindle_rpm_max;
  return turns_well ? ErrorCode::Ok : ErrorCode::SpindleSpeedOutOfRange;
}

void note_shape(const Block& block, const BlockContext& context, ThreadCycle& thread) {
  const auto length_mm = [&](float value) {
    const float mm = block.modal.inches ? inches_to_mm(context.rules.floats, value) : value;
    return block.modal.diameter ? mm / 2.0F : mm;
  };
  thread.pitch_mm = block.p;
  thread.end_z_mm = block.xyz[kZ];
  thread.direction = block.ijk[0] < 0.0F ? -1.0F : 1.0F;
  thread.peak_mm = length_mm(std::fabs(block.ijk[0]));
  thread.first_depth_mm = length_mm(block.ijk[1]);
  thread.depth_mm = length_mm(block.ijk[2]);
  if (!block.has_axis(kX)) return;
  // The pitch is counted along the slope of a tapered thread.
  thread.taper_height_mm = block.xyz[kX] - block_offset(block, context, kX);
  const float along_mm = std::fabs(thread.end_z_mm - context.state.position_mm[kZ]);
  thread.pitch_mm *= std::hypot(thread.taper_height_mm, along_mm) / along_mm;
}

void note_end_taper(const Block& block, ThreadCycle& thread) {
  if (block.words.has('L')) {
    thread.tapers_entry = (block.l & kTaperEntry) != 0;
    thread.tapers_exit = (block.l & kTaperExit) != 0;
  }
  if (block.words.has('E')) thread.end_taper_mm = block.written['E' - 'A'];
  if (thread.end_taper_mm > 0.0F && (thread.tapers_entry || thread.tapers_exit)) return;
  thread.end_taper_mm = 0.0F;
  thread.tapers_entry = thread.tapers_exit = false;
}

}  // namespace

ErrorCode check_thread(Block& block, BlockContext& context) {
  if (const ErrorCode error = check_thread_words(block, context); error != ErrorCode::Ok) return error;
  ThreadCycle& thread = context.state.thread;
  if (context.state.modal.motion != MotionMode::Thread) thread = {};
  note_shape(block, context, thread);
  if (block.words.has('H')) thread.spring_passes = static_cast<int>(block.h);
  note_end_taper(block, thread);
  if (thread.end_taper_mm > std::fabs(thread.end_z_mm - context.state.position_mm[kZ]) / 2.0F)
    return ErrorCode::ValueOutOfRange;
  if (block.words.has('R')) thread.degression = block.r;
  if (block.words.has('Q')) thread.infeed_angle_deg = block.q;
  block.spindle_force_sync = true;
  block.words.take_all("EHIJKLPQR");
  return ErrorCode::Ok;
}

}  // namespace kerf::gcode
