#include "preparation/checked_job.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "preparation/check_text.hpp"
#include "rehearsal/check.hpp"
#include "sender/job/wire_form.hpp"

namespace kerf::preparation {
namespace {

using rehearsal::Checker;
using rehearsal::CheckResult;
using rehearsal::FindingGroup;
using rehearsal::FindingKind;
using rehearsal::Severity;

/// Read at once, while nothing else is looked at: less than a tenth of a second.
constexpr std::size_t kPieceBytes = 2'000'000;
/// What takes longer than a second is worth a word.
constexpr std::size_t kLongBytes = 40'000'000;

job::WireForm form_of(const session::Session& session, const session::JobOptions& options) {
  job::WireForm form = job::wire_form_of(vocabulary::dialect_of(session.capabilities().family));
  form.keeps_marks = session.snapshot().texts_keep_realtime.value_or(false);
  form.optional_stop = options.optional_stop;
  form.block_delete = options.block_delete;
  return form;
}

std::uint32_t first_error(const CheckResult& result) {
  const auto is_error = [](const FindingGroup& group) { return group.severity == Severity::Error; };
  const auto found = std::ranges::find_if(result.groups, is_error);
  return found == result.groups.end() ? 0 : found->first.front().line;
}

class CheckedJobPreparation final : public JobPreparation {
 public:
  explicit CheckedJobPreparation(CheckedJob job) : job_(std::move(job)) {}

  void on_event(const session::Event&) override {}
  void agree() override {}

  NextInPreparation next(Instant, const session::Session& session) override {
    using vocabulary::MachineState;
    const MachineState state = session.snapshot().state;
    const bool can_start = state == MachineState::Idle || state == MachineState::Check;
    // The session says better why there will be no job.
    if (!can_start || session.capabilities().family == vocabulary::Firmware::Unknown) return begin({});
    if (!checker_) {
      checker_.emplace(*job_.program, rehearsal::check_machine_of(session.capabilities(), session.snapshot()),
                       form_of(session, job_.options));
      if (job_.program->size_bytes() > kLongBytes) return KeepWaiting{true, "Checking the program first."};
    }
    if (checker_->read_on(kPieceBytes)) return KeepWaiting{.is_at_work = true, .sentence = progress()};
    return settle(checker_->finish(), session.capabilities().firmware);
  }

 private:
  [[nodiscard]] NextInPreparation settle(const CheckResult& result, const std::string& firmware) const {
    Told told{.lines = check_lines_for_run(result),
              .event = {{"event", "checked"}, {"check", check_json(result, firmware)}}};
    // Lines that are too long are never sent, and the session says so.
    const auto is_too_long = [](const FindingGroup& group) { return group.kind == FindingKind::LineTooLong; };
    const bool starts = job_.despite_errors || std::ranges::any_of(result.groups, is_too_long);
    if (result.errors == 0 || starts) return begin(std::move(told));
    return NoJob{.told = std::move(told),
                 .sentence = fmt::format("{} was not started: the check found {} error{}, the first at line {}. Mend "
                                         "the program, or start it with --despite-errors.",
                                         job_.program->name(), result.errors, result.errors == 1 ? "" : "s",
                                         first_error(result)),
                 .reason = NoJob::Reason::FaultsFound};
  }

  /// Now and then, where it takes long.
  [[nodiscard]] std::string progress() {
    constexpr int kTenths = 10;
    const int tenths = static_cast<int>(checker_->share_read() * kTenths);
    if (job_.program->size_bytes() <= kLongBytes || tenths <= told_tenths_) return {};
    told_tenths_ = tenths;
    return fmt::format("Checked {} % of the program.", tenths * kTenths);
  }

  [[nodiscard]] BeginJob begin(Told told) const {
    return {.told = std::move(told), .job = {.program = job_.program, .origin = job_.origin}};
  }

  CheckedJob job_;
  std::optional<Checker> checker_;
  int told_tenths_ = 0;
};

}  // namespace

std::unique_ptr<JobPreparation> prepare_checked_job(CheckedJob job) {
  return std::make_unique<CheckedJobPreparation>(std::move(job));
}

}  // namespace kerf::preparation
