#include "rehearsal/report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rehearsal/report_sections.hpp"
#include "rehearsal/report_style.hpp"

namespace kerf::rehearsal {

std::string to_html(const Report& report) {
  Markup page;
  page.raw(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
      "<title>");
  page.text(report.file.name).raw(" \xE2\x80\x93 job report</title>\n<style>").raw(kReportStyle);
  page.raw("</style>\n</head>\n<body>\n");
  add_head(page, report);
  add_figures(page, report);
  add_pictures(page, report);
  add_findings(page, report);
  add_times(page, report);
  add_operations(page, report);
  add_tools(page, report);
  add_limits(page, report);
  add_file(page, report);
  page.raw("<footer>").text("Made by " + report.made_by + " on " + report.made_at + ". ");
  page.raw(
      "Times are those of the machine\xE2\x80\x99s own planner, with overrides at 100 %; what people need at a stop or "
      "a "
      "tool change is not counted.</footer>\n</body>\n</html>\n");
  return std::move(page).take();
}

}  // namespace kerf::rehearsal
