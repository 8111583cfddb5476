#include "rehearsal/arc_fitter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "rehearsal/number_text.hpp"

namespace kerf::rehearsal {
namespace {

/// Two lines lie on many arcs.
constexpr std::size_t kLeastPieces = 3;
/// Keeps the work for a line small.
constexpr std::size_t kMostPieces = 256;
constexpr double kLargest_mm = 10'000;
/// Beyond that the two ends come close, and the last bits decide.
constexpr double kMostSweep_rad = 1.8 * std::numbers::pi;
constexpr double kMostStep_rad = std::numbers::pi / 3;

/// The G word that a line needs, if any.
std::optional<int> motion_of(const LineFacts& facts, const gcode::ArcMove* arc) {
  if (facts.use == AxisUse::Line) return facts.is_rapid ? 0 : 1;
  if (facts.use == AxisUse::Arc && arc != nullptr) return arc->clockwise ? 2 : 3;
  return std::nullopt;
}

}  // namespace

ArcFitter::ArcFitter(double tolerance_mm, const vocabulary::Dialect& dialect)
    : tolerance_mm_(tolerance_mm), dialect_(&dialect), reading_(dialect), proof_(dialect) {}

void ArcFitter::restart() {
  reading_ = ProgramReading(*dialect_);
  proof_ = ProgramReading(*dialect_);
  motion_ = {};
  run_.clear();
  circle_.reset();
  feed_.clear();
}

bool ArcFitter::may_belong(const LineText& text, const LineFacts& facts) const {
  constexpr AxisMask kPlane = mask_of_axis(kX) | mask_of_axis(kY);
  if (facts.use != AxisUse::Line || facts.is_rapid || facts.ends || facts.modal.incremental || facts.modal.scaling ||
      facts.modal.plane != gcode::Plane::XY || facts.modal.feed_mode != gcode::FeedMode::UnitsPerMinute ||
      (facts.named & ~kPlane) != 0 || (facts.from.known & facts.to.known & kPlane) != kPlane ||
      text.line().find_first_of("(;/") != std::string::npos) {
    return false;
  }
  return std::ranges::all_of(text.words(), [&](const PlacedWord& word) {
    if (word.letter == 'G') return word.value == 1;
    if (word.letter == 'F') return run_.empty() || word.digits == feed_;
    return word.letter == 'X' || word.letter == 'Y' || (word.letter == 'N' && run_.empty());
  });
}

bool ArcFitter::fits(const Circle& circle, std::size_t pieces) const {
  const double turn = circle.clockwise ? -1 : 1;
  double swept = 0;
  Spot at = from_;
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const Spot to = run_[piece].to;
    const double x0 = at.x_mm - circle.center.x_mm;
    const double y0 = at.y_mm - circle.center.y_mm;
    const double x1 = to.x_mm - circle.center.x_mm;
    const double y1 = to.y_mm - circle.center.y_mm;
    const double step = turn * std::atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1);
    if (step <= 0 || step > kMostStep_rad) return false;
    swept += step;
    const double height = circle.radius_mm * (1 - std::cos(step / 2));
    if (std::abs(std::hypot(x1, y1) - circle.radius_mm) > tolerance_mm_ || height > tolerance_mm_) return false;
    at = to;
  }
  return swept <= kMostSweep_rad;
}

std::optional<ArcFitter::Circle> ArcFitter::circle_of(std::size_t pieces) const {
  if (pieces < 2) return std::nullopt;
  const Spot a = from_;
  const Spot b = run_[(pieces - 1) / 2].to;
  const Spot c = run_[pieces - 1].to;
  const double bx = b.x_mm - a.x_mm;
  const double by = b.y_mm - a.y_mm;
  const double cx = c.x_mm - a.x_mm;
  const double cy = c.y_mm - a.y_mm;
  const double cross = 2 * (bx * cy - by * cx);
  const double b2 = bx * bx + by * by;
  const double c2 = cx * cx + cy * cy;
  if (std::abs(cross) <= 1e-12 * (b2 + c2)) return std::nullopt;
  const double x = (cy * b2 - by * c2) / cross;
  const double y = (bx * c2 - cx * b2) / cross;
  const Circle circle{
      .center = {.x_mm = a.x_mm + x, .y_mm = a.y_mm + y}, .radius_mm = std::hypot(x, y), .clockwise = cross < 0};
  if (circle.radius_mm > kLargest_mm || !fits(circle, pieces)) return std::nullopt;
  return circle;
}

ArcFitter::Done ArcFitter::on_line(SourceLine line, LineQueue& out) {
  const LineText text(line.text);
  const auto facts = reading_.read(text, line.number);
  if (!facts) return std::unexpected{facts.error()};
  if (facts->is_over) {
    if (auto done = end_run(out); !done) return done;
    out.put(std::move(line));
    return {};
  }
  if (!may_belong(text, *facts)) {
    if (auto done = end_run(out); !done) return done;
  }
  // The run that has just ended may have been what stood in its way.
  if (!may_belong(text, *facts)) {
    note_feed(text);
    return put_line(std::move(line), motion_of(*facts, reading_.arc()), out);
  }
  if (run_.empty()) {
    from_ = {.x_mm = facts->from.mm.at(kX), .y_mm = facts->from.mm.at(kY)};
    unit_mm_ = unit_mm(facts->modal);
    note_feed(text);
  }
  return add({.line = std::move(line), .to = {.x_mm = facts->to.mm.at(kX), .y_mm = facts->to.mm.at(kY)}}, out);
}

ArcFitter::Done ArcFitter::add(Piece piece, LineQueue& out) {
  run_.push_back(std::move(piece));
  while (!run_.empty()) {
    if (run_.size() < 2) return {};
    if (const auto circle = circle_of(run_.size()); circle && run_.size() <= kMostPieces) {
      circle_ = circle;
      return {};
    }
    // The last one does not go with the others. Either they are an arc, or the first one is a line for good.
    Piece last = std::move(run_.back());
    run_.pop_back();
    if (run_.size() >= kLeastPieces && circle_) {
      if (auto done = put_arc(*circle_, out); !done) return done;
      from_ = run_.back().to;
      run_.clear();
    } else {
      from_ = run_.front().to;
      if (auto done = put_line(std::move(run_.front().line), 1, out); !done) return done;
      run_.erase(run_.begin());
    }
    circle_.reset();
    run_.push_back(std::move(last));
    // What is left of a short run may be the beginning of another arc.
    if (run_.size() > 2) circle_ = circle_of(run_.size() - 1);
  }
  return {};
}

ArcFitter::Done ArcFitter::end_run(LineQueue& out) {
  if (run_.size() >= kLeastPieces && circle_) {
    if (auto done = put_arc(*circle_, out); !done) return done;
  } else {
    for (Piece& piece : run_) {
      if (auto done = put_line(std::move(piece.line), 1, out); !done) return done;
    }
  }
  run_.clear();
  circle_.reset();
  return {};
}

ArcFitter::Done ArcFitter::on_end(LineQueue& out) {
  return end_run(out);
}

void ArcFitter::note_feed(const LineText& text) {
  for (const double word : {20, 21, 93, 94, 95}) {
    if (text.has_command('G', word)) feed_.clear();
  }
  if (const PlacedWord* const feed = text.find('F')) feed_ = feed->digits;
}

ArcFitter::Done ArcFitter::put_line(SourceLine line, std::optional<int> motion, LineQueue& out) {
  LineText text(std::move(line.text));
  if (motion) motion_.say(text, *motion);
  const LineText written(text.text());
  motion_.note(written);
  if (auto read = proof_.read(written, line.number); !read) return std::unexpected{read.error()};
  line.text = written.line();
  out.put(std::move(line));
  return {};
}

ArcFitter::Done ArcFitter::put_arc(const Circle& circle, LineQueue& out) {
  const SourceLine& first = run_.front().line;
  const Spot to = run_.back().to;
  LineText text(first.text);
  ModalMotion motion = motion_;
  motion.say(text, circle.clockwise ? 2 : 3);
  const auto length = [this](double mm) { return length_text(mm / unit_mm_, unit_mm_); };
  put_words(text, "XY",
            {{'X', length(to.x_mm)},
             {'Y', length(to.y_mm)},
             {'I', length(circle.center.x_mm - from_.x_mm)},
             {'J', length(circle.center.y_mm - from_.y_mm)}});
  const LineText written(text.text());
  ProgramReading trial = proof_;
  if (!trial.read(written, first.number) || trial.arc() == nullptr) {
    for (Piece& piece : run_) {
      if (auto done = put_line(std::move(piece.line), 1, out); !done) return done;
    }
    return {};
  }
  proof_ = std::move(trial);
  motion_ = motion;
  out.put({.text = written.line(), .number = first.number, .end = first.end});
  return {};
}

}  // namespace kerf::rehearsal
