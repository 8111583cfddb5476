#pragma once
// Compares what the machine does with the program while a job runs.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/time.hpp"
#include "common/gcode/interpreter.hpp"
#include "sender/job/executing_lines.hpp"
#include "sender/job/path_follower.hpp"
#include "sender/job/path_forecast.hpp"
#include "sender/machine/capabilities.hpp"
#include "sender/machine/snapshot.hpp"

namespace kerf::job {

/// Where the path is not watched, and why: one sentence.
struct PathGap {
  std::uint32_t file_line = 0;
  std::string sentence;
};

/// Told of every line that is sent and answered and of every report; says when the machine leaves the path, and which
/// lines it may be executing. Memory and time do not grow with the length of the job.
class PathWatch {
 public:
  /// `reader` stands where the last line leads; empty where that is not known. `clock`: seconds of the machine's clock
  /// in one of ours.
  void begin(Instant now, const std::optional<gcode::Interpreter>& reader, const machine::Snapshot& snapshot,
             const machine::Capabilities& known, double clock);
  void on_sent(std::uint32_t file_line, std::string_view text);
  /// The oldest line that was told and not answered is answered.
  void on_answer(std::uint32_t file_line, int error_code);
  /// `asked`: when the question went out that this report answers, the earliest one if there were several.
  [[nodiscard]] std::optional<PathDeparture> on_report(Instant now, std::optional<Instant> asked,
                                                       const machine::Snapshot& snapshot);
  /// A cycle start leaves.
  void on_cycle_start();
  /// The operator goes on although the machine is not where the program says.
  void on_overruled();
  /// The operator sends a line by hand while the job waits for its tool.
  void on_work_by_hand(std::string_view text) { forecast_.on_work_by_hand(text); }
  /// Told of every report: where the path had become unknown, a machine that stands still with nothing on its way shows
  /// where it goes on.
  void look_for_rest(Instant now, const machine::Snapshot& snapshot, bool nothing_on_its_way);

  [[nodiscard]] ExecutingLines executing() const { return follower_.executing(forecast_); }
  /// Once for each job that is not watched to its end.
  [[nodiscard]] std::optional<PathGap> take_gap();

 private:
  PathForecast forecast_;
  PathFollower follower_;
  /// Where it rested in the last report.
  std::optional<AxisValues> rested_at_mm_;
  /// Where it stood in the last report, held in the middle of the path.
  std::optional<AxisValues> stood_at_mm_;
  bool tells_work_position_ = false;
  bool gap_told_ = false;
  bool stands_ = false;
  /// A cycle start has left since it stands.
  bool restarted_ = false;
};

}  // namespace kerf::job
