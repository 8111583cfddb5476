#include "simulation/motion_trace.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <variant>

#include "common/base/overloaded.hpp"
#include "common/base/text.hpp"
#include "common/protocol/decode.hpp"
#include "common/vocabulary/realtime.hpp"
#include "firmware/virtual_controller.hpp"
#include "simulation/standstill.hpp"
#include "simulation/switched_on.hpp"

namespace kerf::simulation {
namespace {

using firmware::VirtualController;

constexpr std::int64_t kBitsPerByte = 10;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
/// What a careful sender has under way at most (interpreter-cases.md).
constexpr std::size_t kWindow = 127;
constexpr std::size_t kGrblHalWindow = 900;
constexpr std::size_t kRoomForRealtime = 32;

std::size_t window_of(vocabulary::Firmware firmware) {
  return firmware == vocabulary::Firmware::GrblHal ? kGrblHalWindow : kWindow;
}

/// Decides when which byte of the program arrives.
class Feeder {
 public:
  Feeder(std::unique_ptr<ProgramText> text, ProgramLink link, std::size_t window)
      : text_(std::move(text)), link_(link), window_(window) {
    read_on();
    find_next_line();
  }

  /// When the next bytes arrive if nothing is answered before; kNever if that needs an answer or room.
  [[nodiscard]] Instant next_arrival() const { return link_.baud && sent_ < allowed_ ? byte_at_ : kNever; }

  /// What arrives now; `room` is what the receive buffer can take.
  std::string_view take(Instant now, std::size_t room) {
    read_on();
    const std::size_t first = sent_;
    if (!link_.baud) {
      sent_ = std::min(bytes_.size(), sent_ + room);
    } else if (sent_ < allowed_ && byte_at_ <= now) {
      ++sent_;
      ++bytes_on_line_;
      place_next_byte();
      find_next_line();
    }
    return std::string_view{bytes_}.substr(first, sent_ - first);
  }

  /// A line of the program was answered.
  void answered(Instant now) {
    if (lines_under_way_.empty()) return;
    under_way_ -= lines_under_way_.front();
    lines_under_way_.pop_front();
    read_on();
    const bool was_waiting = sent_ == allowed_;
    find_next_line();
    if (was_waiting && sent_ < allowed_ && byte_at_ < now) {
      // The byte that begins now has arrived when its ten bits have.
      line_began_ = now + byte_time();
      bytes_on_line_ = 0;
      place_next_byte();
    }
  }

  /// Of the program; how many there are in all is known at its end.
  [[nodiscard]] std::uint32_t lines_read() const { return lines_; }
  [[nodiscard]] bool has_read_all() const { return text_ == nullptr; }
  /// Counts the lines that are left, when they are not to be sent any more.
  std::uint32_t count_rest() {
    while (text_) {
      bytes_.clear();
      read_piece();
    }
    return lines_;
  }

 private:
  /// Keeps some bytes ready behind those that were sent.
  void read_on() {
    constexpr std::size_t kReady = 4096;
    if (!text_ || bytes_.size() - sent_ >= kReady) return;
    bytes_.erase(0, sent_);
    allowed_ -= std::min(allowed_, sent_);
    sent_ = 0;
    while (text_ && bytes_.size() < 2 * kReady) read_piece();
  }
  void read_piece() {
    const std::size_t before = bytes_.size();
    if (!text_->read_on(bytes_)) text_.reset();
    lines_ += static_cast<std::uint32_t>(
        std::ranges::count(bytes_.begin() + static_cast<std::ptrdiff_t>(before), bytes_.end(), '\n'));
  }

  /// A line may follow when all of it fits into the window.
  void find_next_line() {
    if (!link_.baud) return;
    while (allowed_ < bytes_.size()) {
      const std::size_t length = bytes_.find('\n', allowed_) + 1 - allowed_;
      if (under_way_ != 0 && under_way_ + length > window_) return;
      under_way_ += length;
      lines_under_way_.push_back(length);
      allowed_ += length;
    }
  }

  [[nodiscard]] Duration byte_time() const { return Duration{kBitsPerByte * kNanosecondsPerSecond / *link_.baud}; }

  /// Time zero is the instant at which the first byte has arrived.
  void place_next_byte() {
    byte_at_ = line_began_ + Duration{bytes_on_line_ * kBitsPerByte * kNanosecondsPerSecond / *link_.baud};
  }

  /// Null when all of it was read.
  std::unique_ptr<ProgramText> text_;
  std::uint32_t lines_ = 0;
  std::string bytes_;
  ProgramLink link_;
  std::size_t window_;
  std::size_t sent_ = 0;
  std::size_t allowed_ = 0;
  std::size_t under_way_ = 0;
  std::deque<std::size_t> lines_under_way_;
  /// Since when the wire has been busy without a gap, and with how many bytes.
  Instant line_began_{};
  std::int64_t bytes_on_line_ = 0;
  Instant byte_at_{};
};

/// Blocks that are given away at once.
constexpr std::size_t kPiece = 1000;

}  // namespace

class ProgramTracer::Run {
 public:
  Run(const ProgramRun& run, const CaseMachine& machine, std::unique_ptr<ProgramText> text)
      : run_(run),
        controller_(machine.personality, machine.stored),
        feeder_(std::move(text), run.link, window_of(machine.personality.firmware)) {
    for (const auto& event : machine.workcell) controller_.submit(now_, event);
    if (machine.personality.full_buffer_drops_realtime) kept_free_ = kRoomForRealtime;
    switch_on(controller_, now_, machine.told);
    log_ = &controller_.keep_motion_log();
    next_sample_ = run.sample_every ? Instant{} : kNever;
    feed();
  }

  bool run_on(std::vector<BlockTrace>& ended) {
    const std::size_t enough = ended.size() + kPiece;
    while (ended.size() < enough) {
      const Instant next = next_instant();
      if (next == kNever && goes_on()) continue;
      if (next == kNever || standstill_.lasts(controller_, trace_.lines_answered)) {
        while (const auto begun = log_->take_begun()) ended.push_back(block_of(*begun));
        return false;
      }
      sample_before(next);
      now_ = std::max(now_, next);
      controller_.advance_to(now_);
      inject();
      feed();
      while (const auto finished = log_->take_finished()) ended.push_back(block_of(*finished));
    }
    return true;
  }

  MotionTrace finish() {
    const Instant end = std::max(log_->last_end(), last_answer_);
    trace_.total_s = base::to_seconds(end - Instant{});
    trace_.lines = feeder_.count_rest();
    if (run_.sample_every) {
      while (next_sample_ < end + *run_.sample_every) take_sample();
    }
    trace_.final_steps = steps();
    trace_.final_mm = controller_.position_mm();
    trace_.block_count = log_->blocks();
    return std::move(trace_);
  }

 private:
  [[nodiscard]] Instant next_instant() const {
    const Instant by_itself = controller_.next_deadline();
    if (by_itself == kNever && is_over() && controller_.state() == vocabulary::MachineState::Idle) return kNever;
    return std::min({by_itself, feeder_.next_arrival(), next_injection()});
  }

  [[nodiscard]] bool is_over() const { return feeder_.has_read_all() && trace_.lines_answered >= feeder_.lines_read(); }

  /// The operator presses Cycle Start, unless that did not help a moment ago.
  bool goes_on() {
    using vocabulary::MachineState;
    const MachineState state = controller_.state();
    const bool waits = state == MachineState::Hold || state == MachineState::Tool;
    const std::uint32_t line = trace_.lines_answered + 1;
    if (!run_.operator_goes_on || !waits || (!trace_.stops.empty() && trace_.stops.back() == line)) return false;
    trace_.stops.push_back(line);
    const auto start = static_cast<char>(vocabulary::Realtime::CycleStart);
    controller_.on_bytes(now_, std::string_view{&start, 1});
    feed();
    return true;
  }

  static BlockTrace block_of(const firmware::FinishedMove& move) {
    return {.line = move.planned.line,
            .start_s = base::to_seconds(move.executed.began - Instant{}),
            .end_s = base::to_seconds(move.executed.ended - Instant{}),
            .length_mm = static_cast<double>(move.planned.length_mm),
            .rate_mm_per_min = static_cast<double>(move.planned.rate_mm_per_min),
            .rapid = move.planned.rapid,
            .end_steps = move.executed.end_steps};
  }

  [[nodiscard]] Instant next_injection() const {
    return injected_ < run_.inject.size() ? Instant{} + run_.inject[injected_].after : kNever;
  }

  void inject() {
    for (; next_injection() <= now_; ++injected_) {
      const char byte = static_cast<char>(run_.inject[injected_].byte);
      controller_.on_bytes(now_, std::string_view{&byte, 1});
    }
  }

  void feed() {
    for (;;) {
      listen();
      const std::size_t room = controller_.receive_room();
      const std::string_view bytes = feeder_.take(now_, room > kept_free_ ? room - kept_free_ : 0);
      if (bytes.empty()) return;
      controller_.on_bytes(now_, bytes);
    }
  }

  void listen() {
    const std::string heard = controller_.take_outbox();
    if (heard.empty()) return;
    for (std::string_view line : base::split(heard, '\n')) {
      if (line.ends_with('\r')) line.remove_suffix(1);
      std::visit(base::Overloaded{
                     [&](const protocol::Ok&) { answered(0); },
                     [&](const protocol::ErrorAnswer& error) { answered(error.code); },
                     [&](const protocol::AlarmRaised& alarm) { trace_.alarms.push_back(alarm.code); },
                     [](const auto&) {},
                 },
                 protocol::decode(line));
    }
  }

  void answered(int code) {
    ++trace_.lines_answered;
    last_answer_ = now_;
    if (code != 0) trace_.errors.push_back({.line = trace_.lines_answered, .code = code});
    feeder_.answered(now_);
  }

  /// Samples up to, but not at, `next`: what happens at that instant comes first.
  void sample_before(Instant next) {
    while (next_sample_ < next) take_sample();
  }

  void take_sample() {
    controller_.advance_to(next_sample_);
    now_ = std::max(now_, next_sample_);
    trace_.positions.push_back({.at_s = base::to_seconds(next_sample_ - Instant{}), .steps = steps()});
    next_sample_ += *run_.sample_every;
  }

  [[nodiscard]] std::vector<std::int32_t> shortened(const vocabulary::AxisSteps& steps) const {
    return {steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(controller_.position_mm().size())};
  }
  [[nodiscard]] std::vector<std::int32_t> steps() const { return shortened(controller_.position_steps()); }

  const ProgramRun& run_;
  VirtualController controller_;
  /// Rabbit loses realtime bytes that meet a full buffer: a sender that keeps it full leaves room for them.
  std::size_t kept_free_ = 0;
  Feeder feeder_;
  firmware::MotionLog* log_ = nullptr;
  Standstill standstill_;
  MotionTrace trace_;
  Instant now_{};
  Instant last_answer_{};
  Instant next_sample_ = kNever;
  std::size_t injected_ = 0;
};

ProgramTracer::ProgramTracer(const ProgramRun& run, const CaseMachine& machine)
    : ProgramTracer(run, machine, std::make_unique<HeldText>(run.program)) {}
ProgramTracer::ProgramTracer(const ProgramRun& run, const CaseMachine& machine, std::unique_ptr<ProgramText> text)
    : run_(std::make_unique<Run>(run, machine, std::move(text))) {}
ProgramTracer::~ProgramTracer() = default;

bool ProgramTracer::run_on(std::vector<BlockTrace>& ended) {
  return run_->run_on(ended);
}

MotionTrace ProgramTracer::finish() {
  return run_->finish();
}

MotionTrace trace_program(const ProgramRun& run, const CaseMachine& machine) {
  ProgramTracer tracer(run, machine);
  std::vector<BlockTrace> blocks;
  while (tracer.run_on(blocks)) {
    if (!run.keeps_blocks) blocks.clear();
  }
  MotionTrace trace = tracer.finish();
  if (run.keeps_blocks) trace.blocks = std::move(blocks);
  return trace;
}

}  // namespace kerf::simulation
