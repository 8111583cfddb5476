#include <cmath>
#include <cstring>

#include "common/gcode/checks.hpp"
#include "common/gcode/numbers.hpp"

namespace kerf::gcode {

namespace {

constexpr std::string_view kOffsetLetters = "IJK";

/// Compared bit for bit, as the firmwares do: 0 and -0 differ.
bool is_where_it_was(const Block& block, const BlockContext& context) {
  return std::memcmp(block.xyz.data(), context.state.position_mm.data(), context.axes() * sizeof(float)) == 0;
}

bool names_plane_axis(const Block& block) {
  return block.has_axis(block.plane.first) || block.has_axis(block.plane.second);
}

float hypotenuse(float x, float y) {
  return std::sqrt(x * x + y * y);
}

struct Chord {
  float x;
  float y;
};

/// From the position to the target, in the plane.
Chord chord_of(const Block& block, const BlockContext& context) {
  const AxisValues& from = context.state.position_mm;
  return {.x = block.xyz[block.plane.first] - from[block.plane.first],
          .y = block.xyz[block.plane.second] - from[block.plane.second]};
}

/// 4 r^2 - x^2 - y^2 with a double literal on Rabbit: on the edge of the half circle its sign decides between ok and
/// error:34.
float four_h_squared(FloatRule floats, float r, Chord chord) {
  if (floats == FloatRule::Single) return 4.0F * r * r - chord.x * chord.x - chord.y * chord.y;
  const double four_r_squared = 4.0 * static_cast<double>(r) * static_cast<double>(r);
  return static_cast<float>(four_r_squared - static_cast<double>(chord.x * chord.x) -
                            static_cast<double>(chord.y * chord.y));
}

/// R form: centre offset and positive radius from target and signed radius (negative: the long way round).
ErrorCode find_center(Block& block, const BlockContext& context) {
  const FloatRule floats = context.rules.floats;
  const Chord chord = chord_of(block, context);
  const float squared = four_h_squared(floats, block.r, chord);
  if (squared < 0.0F) return ErrorCode::ArcRadiusError;

  float h_by_half_chord = -std::sqrt(squared) / hypotenuse(chord.x, chord.y);
  if (block.modal.motion == MotionMode::CounterclockwiseArc) h_by_half_chord = -h_by_half_chord;
  if (block.r < 0.0F) {
    h_by_half_chord = -h_by_half_chord;
    block.r = -block.r;
  }
  block.ijk[block.plane.first] = 0.5F * (chord.x - chord.y * h_by_half_chord);
  block.ijk[block.plane.second] = 0.5F * (chord.y + chord.x * h_by_half_chord);
  return ErrorCode::Ok;
}

/// The radii at start and target may differ by 0.5 mm at most, and from 0.005 mm on by a thousandth.
bool radii_agree(FloatRule floats, float target_radius, float radius) {
  const float difference = std::fabs(target_radius - radius);
  if (floats == FloatRule::Single) {
    if (!(difference > 0.005F)) return true;
    return !(difference > 0.5F) && !(difference > 0.001F * radius);
  }
  if (!(static_cast<double>(difference) > 0.005)) return true;
  return !(static_cast<double>(difference) > 0.5) &&
         !(static_cast<double>(difference) > 0.001 * static_cast<double>(radius));
}

/// I, J, K form: the radius from the offsets, which must fit the target.
ErrorCode check_center(Block& block, const BlockContext& context) {
  if (!block.has_ijk(block.plane.first) && !block.has_ijk(block.plane.second)) return ErrorCode::NoOffsetsInPlane;
  block.words.take_all(kOffsetLetters);
  const FloatRule floats = context.rules.floats;
  const ParserState& state = context.state;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!block.has_ijk(axis)) continue;
    if (block.modal.inches) block.ijk[axis] = inches_to_mm(floats, block.ijk[axis]);
    if (state.modal.scaling) block.ijk[axis] *= state.scale_factor[axis];
  }
  const float i = block.ijk[block.plane.first];
  const float j = block.ijk[block.plane.second];
  const Chord chord = chord_of(block, context);
  const float target_radius = hypotenuse(chord.x - i, chord.y - j);
  block.r = hypotenuse(i, j);
  return radii_agree(floats, target_radius, block.r) ? ErrorCode::Ok : ErrorCode::InvalidTarget;
}

ErrorCode check_arc(Block& block, BlockContext& context) {
  block.clockwise = block.modal.motion == MotionMode::ClockwiseArc;
  if (block.axis_words == 0) return ErrorCode::NoAxisWords;
  if (!names_plane_axis(block)) return ErrorCode::NoAxisWordsInPlane;
  if (!block.words.has('R')) return check_center(block, context);

  block.words.take('R');
  if (is_where_it_was(block, context)) return ErrorCode::InvalidTarget;
  if (block.modal.inches) block.r = inches_to_mm(context.rules.floats, block.r);
  return find_center(block, context);
}

/// grblHAL: P is the number of turns, a full circle needs no axis word, mirrored axes turn the other way.
ErrorCode check_arc_grblhal(Block& block, BlockContext& context) {
  const ParserState& state = context.state;
  block.clockwise = block.modal.motion == MotionMode::ClockwiseArc;
  if (block.words.has('R')) {
    if (block.axis_words == 0) return ErrorCode::NoAxisWords;
    if (!names_plane_axis(block)) return ErrorCode::NoAxisWordsInPlane;
  }
  if (block.words.has('P')) {
    if (!is_whole(block.p)) return ErrorCode::CommandValueNotInteger;
    block.turns = static_cast<int>(to_uint32(std::trunc(block.p)));
    if (block.turns == 0) return ErrorCode::ValueOutOfRange;
    block.words.take('P');
  }
  const float factor_first = state.scale_factor[block.plane.first];
  const float factor_second = state.scale_factor[block.plane.second];
  if (state.modal.scaling && factor_first * factor_second < 0.0F) block.clockwise = !block.clockwise;
  if (!block.words.has('R')) return check_center(block, context);

  block.words.take('R');
  if (is_where_it_was(block, context)) return ErrorCode::InvalidTarget;
  if (block.modal.inches) block.r = inches_to_mm(context.rules.floats, block.r);
  if (state.modal.scaling) block.r *= factor_first > factor_second ? factor_first : factor_second;
  return find_center(block, context);
}

ErrorCode check_probe(const Block& block, const BlockContext& context) {
  if (block.axis_words == 0) return ErrorCode::NoAxisWords;
  return is_where_it_was(block, context) ? ErrorCode::InvalidTarget : ErrorCode::Ok;
}

/// grblHAL: P selects a probe, of which there is one.
ErrorCode check_probe_grblhal(Block& block, const BlockContext& context) {
  if (const ErrorCode error = check_probe(block, context); error != ErrorCode::Ok) return error;
  if (!block.words.has('P')) return ErrorCode::Ok;
  block.words.take('P');
  return block.p != 0.0F ? ErrorCode::ValueOutOfRange : ErrorCode::Ok;
}

bool names_other_than_xy(const Block& block) {
  return (block.axis_words & ~0x3U) != 0;
}

void scale_and_convert_ij(Block& block, const BlockContext& context) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (block.modal.inches) block.ijk[axis] = inches_to_mm(context.rules.floats, block.ijk[axis]);
    if (context.state.modal.scaling) block.ijk[axis] *= context.state.scale_factor[axis];
  }
}

/// G5 I J P Q: without I and J the curve goes on as it came.
ErrorCode check_cubic_spline(Block& block, BlockContext& context) {
  if (block.modal.plane != Plane::XY) return ErrorCode::IllegalPlane;
  if (names_other_than_xy(block)) return ErrorCode::AxisCommandConflict;
  if (!block.words.has('P') || !block.words.has('Q')) return ErrorCode::ValueWordMissing;
  const bool begins = block.modal.motion != context.state.modal.motion;
  if (begins && !(block.words.has('I') && block.words.has('J'))) return ErrorCode::ValueWordMissing;
  if (block.words.has_any("IJ")) {
    scale_and_convert_ij(block, context);
  } else {
    block.ijk[0] = -block.p;
    block.ijk[1] = -block.q;
  }
  if (block.modal.inches) {
    block.p = inches_to_mm(context.rules.floats, block.p);
    block.q = inches_to_mm(context.rules.floats, block.q);
  }
  if (context.state.modal.scaling) {
    block.p *= context.state.scale_factor[0];
    block.q *= context.state.scale_factor[1];
  }
  block.words.take_all("PQIJ");
  return ErrorCode::Ok;
}

ErrorCode check_quadratic_spline(Block& block, BlockContext& context) {
  if (block.modal.plane != Plane::XY) return ErrorCode::IllegalPlane;
  if (names_other_than_xy(block)) return ErrorCode::AxisCommandConflict;
  if (!(block.words.has('I') && block.words.has('J'))) return ErrorCode::ValueWordMissing;
  // grblHAL means I and J and asks for I twice.
  if (block.ijk[0] == 0.0F) return ErrorCode::ValueOutOfRange;
  scale_and_convert_ij(block, context);
  block.words.take_all("IJ");
  return ErrorCode::Ok;
}

/// A motion word without axes sets the mode and moves nothing.
ErrorCode allow_no_axes(Block& block) {
  if (block.axis_words == 0) block.axis_command = AxisCommand::None;
  return ErrorCode::Ok;
}

ErrorCode check_shape_grblhal(Block& block, BlockContext& context) {
  switch (block.modal.motion) {
    case MotionMode::Linear: return allow_no_axes(block);
    case MotionMode::ClockwiseArc:
    case MotionMode::CounterclockwiseArc: return check_arc_grblhal(block, context);
    case MotionMode::ProbeToward:
    case MotionMode::ProbeTowardNoError:
    case MotionMode::ProbeAway:
    case MotionMode::ProbeAwayNoError: return check_probe_grblhal(block, context);
    case MotionMode::CubicSpline: return check_cubic_spline(block, context);
    case MotionMode::QuadraticSpline: return check_quadratic_spline(block, context);
    default: return ErrorCode::Ok;
  }
}

}  // namespace

ErrorCode check_motion(Block& block, BlockContext& context) {
  if (block.modal.motion == MotionMode::None) return block.axis_words != 0 ? ErrorCode::AxisWordsExist : ErrorCode::Ok;
  if (block.axis_command != AxisCommand::Motion) return ErrorCode::Ok;
  if (block.modal.motion == MotionMode::Rapid) return allow_no_axes(block);
  if (block.f == 0.0F) return ErrorCode::UndefinedFeedRate;
  switch (block.modal.motion) {
    case MotionMode::Linear: return allow_no_axes(block);
    case MotionMode::ClockwiseArc:
    case MotionMode::CounterclockwiseArc: return check_arc(block, context);
    default: return check_probe(block, context);
  }
}

namespace {

ErrorCode check_synchronized(Block& block, BlockContext& context) {
  if (block.modal.motion == MotionMode::Thread) return check_thread(block, context);
  if (block.k_pitch == 0.0F) return ErrorCode::ValueOutOfRange;
  block.spindle_force_sync = true;
  // grblHAL/core has no rigid tapping of its own.
  return block.modal.motion == MotionMode::RigidTap ? ErrorCode::UnsupportedCommand : ErrorCode::Ok;
}

}  // namespace

ErrorCode check_motion_grblhal(Block& block, BlockContext& context) {
  const MotionMode motion = block.modal.motion;
  if (motion == MotionMode::None) {
    const bool unwanted = block.axis_words != 0 && block.axis_command != AxisCommand::NonModal;
    if (!unwanted) block.modal.retract = RetractMode::Previous;
    return unwanted ? ErrorCode::AxisWordsExist : ErrorCode::Ok;
  }
  if (block.axis_command != AxisCommand::Motion) return ErrorCode::Ok;
  if (motion == MotionMode::Rapid) return allow_no_axes(block);
  if (!block.modal.canned_cycle) block.modal.retract = RetractMode::Previous;
  if (block.modal.surface_speed && (block.modal.spindle == SpindleDirection::Off || block.s == 0.0F))
    return ErrorCode::SpindleNotRunning;
  const bool needs_encoder =
      motion == MotionMode::SpindleSynchronized || motion == MotionMode::RigidTap || motion == MotionMode::Thread;
  if (needs_encoder && !context.settings.spindle_encoder) return ErrorCode::UnsupportedCommand;
  if (needs_encoder) return check_synchronized(block, context);
  if (block.f == 0.0F) return ErrorCode::UndefinedFeedRate;
  if (block.modal.canned_cycle) {
    if (const ErrorCode error = check_canned_cycle(block, context); error != ErrorCode::Ok) return error;
  }
  return check_shape_grblhal(block, context);
}

}  // namespace kerf::gcode
