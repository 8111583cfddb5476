#include "rehearsal/job_estimate.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <utility>

#include "common/vocabulary/dialect.hpp"
#include "rehearsal/program_walk.hpp"
#include "rehearsal/sent_lines.hpp"
#include "sender/job/operations.hpp"
#include "sender/job/program_flow.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::rehearsal {
namespace {

using simulation::BlockTrace;
using simulation::CaseMachine;
using simulation::MotionTrace;
using simulation::ProgramLink;
using simulation::ProgramRun;
using simulation::ProgramTracer;

constexpr std::uint32_t kMarks = 1024;
constexpr std::array<double, 11> kFeedBins = {0, 100, 200, 500, 1000, 2000, 3000, 5000, 7500, 10'000, 20'000};
/// Shorter losses are the gaps that any link has.
constexpr double kNoticeable_s = 0.1;
/// The machine loses so much of the time of these lines at least.
constexpr double kNoticeableShare = 0.02;

/// Reads the program beside the machine: tool, operation and what the lines since the last motion asked for.
class ReadingAlong {
 public:
  struct Pause {
    bool dwells = false;
    bool changes_tool = false;
  };

  ReadingAlong(const job::Program& program, const vocabulary::Dialect& dialect)
      : program_(program), form_(job::wire_form_of(dialect)), next_(program.line_at(0, 1)) {}

  /// Up to the line that planned a block, or to the end.
  Pause go_to(std::uint32_t line) {
    Pause pause;
    for (; next_ && next_->number <= line; next_ = program_.line_at(program_.offset_after(*next_), next_->number + 1)) {
      if (auto name = operations_.on_line(next_->text)) operation_ = *std::move(name);
      wire_.clear();
      job::append_wire_form(wire_, next_->text, form_);
      const job::FlowWords words = job::flow_words_of(wire_);
      pause.dwells = pause.dwells || words.dwell_s.has_value();
      pause.changes_tool = pause.changes_tool || words.changes_tool;
      in_use_.on_words(words);
      if (words.tool || words.changes_tool) tool_ = "T" + std::to_string(in_use_.number().value_or(0));
    }
    return pause;
  }

  [[nodiscard]] const std::string& tool() const { return tool_; }
  [[nodiscard]] const std::string& operation() const { return operation_; }

 private:
  const job::Program& program_;
  job::WireForm form_;
  std::optional<job::ProgramLine> next_;
  std::string wire_;
  job::OperationFinder operations_;
  ToolInUse in_use_;
  std::string tool_;
  std::string operation_;
};

PartEstimate& part_named(std::vector<PartEstimate>& parts, const std::string& name, std::uint32_t line) {
  if (!parts.empty() && parts.back().name == name) return parts.back();
  const auto found = std::ranges::find(parts, name, &PartEstimate::name);
  if (found != parts.end()) return *found;
  return parts.emplace_back(PartEstimate{.name = name, .first_line = line});
}

std::size_t bin_of(double mm_per_min) {
  return static_cast<std::size_t>(std::ranges::upper_bound(kFeedBins, mm_per_min) - kFeedBins.begin() - 1);
}

/// Adds up blocks as they are cut.
class Ledger {
 public:
  Ledger(const job::Program& program, const vocabulary::Dialect& dialect)
      : walk_(program, dialect), lines_(std::max(program.line_count(), std::uint32_t{1})) {
    sum_.marks_s.resize(std::min(kMarks, lines_));
    for (std::size_t bin = 0; bin < kFeedBins.size(); ++bin) feeds_[bin].from_mm_per_min = kFeedBins.at(bin);
  }

  void on_block(const BlockTrace& block) {
    const double gap_s = std::max(block.start_s - last_end_s_, 0.0);
    const double move_s = std::max(block.end_s - std::max(block.start_s, last_end_s_), 0.0);
    account_for(gap_s, walk_.go_to(block.line));
    (block.rapid ? sum_.use.rapid_s : sum_.use.cutting_s) += move_s;
    (block.rapid ? sum_.rapid_mm : sum_.cutting_mm) += block.length_mm;
    if (!block.rapid) {
      FeedBin& bin = feeds_.at(bin_of(block.rate_mm_per_min));
      bin.total_s += move_s;
      bin.cutting_mm += block.length_mm;
    }
    for (auto* part : {&part_named(sum_.tools, walk_.tool(), block.line),
                       &part_named(sum_.operations, walk_.operation(), block.line)}) {
      part->last_line = std::max(part->last_line, block.line);
      part->total_s += gap_s + move_s;
      (block.rapid ? part->rapid_mm : part->cutting_mm) += block.length_mm;
    }
    last_end_s_ = std::max(last_end_s_, block.end_s);
    if (block.line > 0) mark_of(block.line) = last_end_s_;
  }

  JobEstimate finish(const MotionTrace& trace) {
    account_for(std::max(trace.total_s - last_end_s_, 0.0), walk_.go_to(lines_));
    sum_.total_s = trace.total_s;
    sum_.blocks = trace.block_count;
    sum_.lines = trace.lines;
    sum_.lines_answered = trace.lines_answered;
    sum_.stops = trace.stops;
    sum_.errors = trace.errors;
    sum_.alarms = trace.alarms;
    std::ranges::copy_if(feeds_, std::back_inserter(sum_.feeds), [](const FeedBin& bin) { return bin.cutting_mm > 0; });
    double latest_s = 0;
    for (double& mark : sum_.marks_s) mark = latest_s = std::max(latest_s, mark);
    return std::move(sum_);
  }

 private:
  void account_for(double gap_s, const ReadingAlong::Pause& pause) {
    UseOfTime& use = sum_.use;
    (pause.changes_tool ? use.tool_change_s : pause.dwells ? use.dwell_s : use.other_s) += gap_s;
  }

  double& mark_of(std::uint32_t line) {
    const auto share = static_cast<std::uint64_t>(std::min(line, lines_) - 1) * sum_.marks_s.size() / lines_;
    return sum_.marks_s[static_cast<std::size_t>(share)];
  }

  ReadingAlong walk_;
  std::uint32_t lines_;
  JobEstimate sum_;
  std::array<FeedBin, kFeedBins.size()> feeds_{};
  double last_end_s_ = 0;
};

}  // namespace

JobEstimate estimate_job(const job::Program& program, const CaseMachine& machine, ProgramLink link) {
  const auto& dialect = machine.personality.dialect();
  Ledger ledger(program, dialect);
  const ProgramRun run{.program = {}, .link = link, .operator_goes_on = true};
  ProgramTracer tracer(run, machine, std::make_unique<SentText>(SentLines(program, dialect)));
  std::vector<BlockTrace> ended;
  for (bool goes_on = true; goes_on;) {
    ended.clear();
    goes_on = tracer.run_on(ended);
    for (const BlockTrace& block : ended) ledger.on_block(block);
  }
  return ledger.finish(tracer.finish());
}

std::vector<LostTime> lost_on_the_link(const JobEstimate& planner, const JobEstimate& world) {
  std::vector<LostTime> losses;
  const std::size_t marks = std::min(planner.marks_s.size(), world.marks_s.size());
  const auto line_at = [&](std::size_t mark) {
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(mark) * world.lines / marks) + 1;
  };
  double planner_before_s = 0;
  double world_before_s = 0;
  bool goes_on = false;
  for (std::size_t mark = 0; mark < marks; ++mark) {
    const double needed_s = planner.marks_s[mark] - planner_before_s;
    const double lost_s = world.marks_s[mark] - world_before_s - needed_s;
    planner_before_s = planner.marks_s[mark];
    world_before_s = world.marks_s[mark];
    const bool is_loss = lost_s > needed_s * kNoticeableShare && lost_s > 0;
    if (is_loss && !goes_on) losses.push_back({.first_line = line_at(mark)});
    if (is_loss) {
      losses.back().last_line = std::max(line_at(mark + 1) - 1, losses.back().first_line);
      losses.back().lost_s += lost_s;
    }
    goes_on = is_loss;
  }
  std::erase_if(losses, [](const LostTime& loss) { return loss.lost_s < kNoticeable_s; });
  std::ranges::sort(losses, std::ranges::greater{}, &LostTime::lost_s);
  return losses;
}

}  // namespace kerf::rehearsal
