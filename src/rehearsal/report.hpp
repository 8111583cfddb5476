#pragma once
// Everything that is known of a job before it runs, on one page for the screen and for paper.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rehearsal/check.hpp"
#include "rehearsal/check_machine.hpp"
#include "rehearsal/drawing.hpp"
#include "rehearsal/job_estimate.hpp"
#include "rehearsal/toolpath_summary.hpp"

namespace kerf::rehearsal {

struct ReportFile {
  std::string name;
  std::string hash;
  std::size_t size_bytes = 0;
  std::uint32_t lines = 0;
};

struct ReportPicture {
  std::string caption;
  Drawing drawing;
};

struct Report {
  ReportFile file;
  /// Such as "grblHAL", and where its settings are from.
  std::string firmware;
  std::string settings;
  /// Date and time, and the program that made it.
  std::string made_at;
  std::string made_by;
  CheckMachine machine;
  PathSummary path;
  JobEstimate estimate;
  CheckResult check;
  /// The first is the largest on the page.
  std::vector<ReportPicture> pictures;
};

/// One HTML page that needs nothing else: no scripts, no network, A4 when printed. Whatever the file's comments hold
/// stays text.
[[nodiscard]] std::string to_html(const Report& report);

}  // namespace kerf::rehearsal
