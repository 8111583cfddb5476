#include "rehearsal/report_sections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>

#include "common/base/duration_text.hpp"
#include "common/base/text.hpp"
#include "rehearsal/plot.hpp"
#include "rehearsal/report_charts.hpp"

namespace kerf::rehearsal {
namespace {

using base::clock_text;

constexpr double kPage_px = 760;
constexpr std::size_t kMostRows = 60;
constexpr std::string_view kTimes = " \xC3\x97 ";
constexpr std::string_view kDash = "\xE2\x80\x93";
constexpr Rgb kPlain = 0x1D5FAA;

std::string counted(std::uint64_t count, std::string_view what) {
  return std::to_string(count) + " " + std::string{what} + (count == 1 ? "" : "s");
}

std::string metres(double mm) {
  constexpr double kMetre = 1000;
  constexpr double kMuch = 10'000;
  return mm < kMuch ? base::to_fixed(mm, 0) + " mm" : base::to_fixed(mm / kMetre, 1) + " m";
}

std::string percent(double part, double whole) {
  return whole > 0 ? base::to_fixed(part / whole * 100, 0) + " %" : "";
}

std::string range(const Extent& extent) {
  if (extent.is_empty()) return std::string{kDash};
  const std::string least = paper_number(extent.least);
  const std::string most = paper_number(extent.most);
  return least == most ? most : least + " " + std::string{kDash} + " " + most;
}

std::string css_colour(Rgb colour) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string text = "#";
  for (int shift = 20; shift >= 0; shift -= 4) text += kHex[(colour >> static_cast<unsigned>(shift)) & 0xFU];
  return text;
}

std::string sizes(const PathBounds& bounds) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += kTimes;
    text += paper_number(static_cast<double>(bounds.size_mm(axis)));
  }
  return text + " mm";
}

std::string lines_text(std::uint32_t first, std::uint32_t last) {
  const std::string begin = std::to_string(first);
  return first == last ? begin : begin + " " + std::string{kDash} + " " + std::to_string(last);
}

PathColours colours_of(const Report& report) {
  return {report.path, telling_colour(report.path)};
}

const PartEstimate* part_named(const std::vector<PartEstimate>& parts, std::string_view name) {
  const auto found = std::ranges::find(parts, name, &PartEstimate::name);
  return found == parts.end() ? nullptr : &*found;
}

void add_figure(Markup& page, const ReportPicture& picture, std::string_view kind = {}) {
  page.raw("<figure class=\"")
      .raw(kind)
      .raw("\">")
      .svg(picture.drawing)
      .raw("<figcaption>")
      .text(picture.caption)
      .raw("</figcaption></figure>\n");
}

void add_fact(Markup& page, std::string_view name, std::string_view value, std::string_view more) {
  page.raw("<div><dt>").text(name).raw("</dt><dd>").text(value).raw("<small>").text(more).raw("</small></dd></div>\n");
}

void add_legend(Markup& page, const Report& report, const PathColours& colours) {
  page.raw("<ul class=\"legend\">\n");
  for (const LegendRow& row : colours.legend() | std::views::take(kMostRows)) {
    page.raw("<li><i style=\"background:" + css_colour(row.colour) + "\"></i>").text(row.name).raw("</li>\n");
  }
  if (colours.legend().empty()) {
    page.raw("<li>").text(colours.legend_title()).svg(draw_scale(colours, 180)).raw("</li>\n");
  }
  if (report.path.rapid_count > 0) page.raw("<li><i class=\"dash\"></i>Rapid</li>\n");
  page.raw(
      "<li><svg class=\"zero\" viewBox=\"0 0 14 14\"><circle cx=\"7\" cy=\"7\" r=\"6\" fill=\"#fff\" "
      "stroke=\"#1f2933\"/>"
      "<path d=\"M7 7h6a6 6 0 0 0-6-6zM7 7H1a6 6 0 0 0 6 6z\" fill=\"#1f2933\"/></svg>Work zero</li>\n</ul>\n");
}

std::string_view class_of(Severity severity) {
  switch (severity) {
    case Severity::Error: return "finding is-error";
    case Severity::Warning: return "finding is-warning";
    case Severity::Note: break;
  }
  return "finding";
}

void add_finding(Markup& page, const FindingGroup& group) {
  constexpr std::size_t kShown = 4;
  const FindingRow& row = row_of(group.kind);
  page.raw("<div class=\"").raw(class_of(group.severity)).raw("\"><h3>").text(row.title);
  page.raw(" <span>").text(group.severity == Severity::Error ? "error" : "warning");
  if (!group.code.empty()) page.text(", " + group.code);
  if (group.count > 1) page.text(", " + std::to_string(group.count) + " lines");
  page.raw("</span></h3>\n<ul>\n");
  for (const Finding& finding : group.first | std::views::take(kShown)) {
    page.raw("<li>");
    if (finding.line > 0) page.text("Line " + std::to_string(finding.line) + " ");
    page.raw("<code>").text(base::trim(finding.text)).raw("</code> ").text(finding.what).raw("</li>\n");
  }
  if (group.count > kShown) {
    page.raw("<li class=\"soft\">")
        .text("and " + std::to_string(group.count - kShown) + " more, up to line " + std::to_string(group.last_line));
    page.raw("</li>\n");
  }
  page.raw("</ul>\n<p class=\"soft\">").text(row.reason);
  if (!group.first.empty() && !group.first.front().next.empty()) page.text(" " + group.first.front().next);
  page.raw("</p></div>\n");
}

void add_notes(Markup& page, const CheckResult& check) {
  const auto is_note = [](const FindingGroup& group) { return group.severity == Severity::Note; };
  if (std::ranges::none_of(check.groups, is_note)) return;
  page.raw("<table class=\"notes\">\n").heads({"Note", "Lines", "What"});
  for (const FindingGroup& group : check.groups) {
    if (!is_note(group)) continue;
    std::string lines;
    for (const Finding& finding : group.first) {
      if (finding.line > 0) lines += (lines.empty() ? "" : ", ") + std::to_string(finding.line);
    }
    if (group.count > group.first.size()) lines += " \xE2\x80\xA6 " + std::to_string(group.last_line);
    page.raw("<tr>").cell(row_of(group.kind).title).cell(lines);
    page.cell(group.first.empty() ? std::string_view{} : std::string_view{group.first.front().what}, "name");
    page.raw("</tr>\n");
  }
  page.raw("</table>\n");
}

/// A row of operations or tools begins with its colour and ends with its time.
void add_time_cells(Markup& page, const PartEstimate* part, double total_s, Rgb colour) {
  const double seconds = part == nullptr ? 0 : part->total_s;
  page.cell(clock_text(seconds), "number").cell(percent(seconds, total_s), "number");
  page.raw("<td class=\"bar\">").svg(draw_bar(total_s > 0 ? seconds / total_s : 0, colour)).raw("</td>");
}

}  // namespace

Markup& Markup::cell(std::string_view words, std::string_view kind) {
  raw(kind.empty() ? "<td>" : "<td class=\"");
  if (!kind.empty()) raw(kind).raw("\">");
  return text(words).raw("</td>");
}

Markup& Markup::heads(std::initializer_list<std::string_view> names) {
  raw("<tr>");
  for (const std::string_view name : names) {
    const bool is_number = name.starts_with('#');
    raw(is_number ? "<th class=\"number\">" : "<th>").text(is_number ? name.substr(1) : name).raw("</th>");
  }
  return raw("</tr>\n");
}

void add_head(Markup& page, const Report& report) {
  page.raw("<header><div><h1>").text(report.file.name).raw("</h1><p class=\"soft\">");
  page.text("Job report for " + report.firmware + " with " + report.settings).raw("</p></div>\n");
  // Kinds of them: a feed that is too high is one thing, on however many lines.
  const auto kinds = [&report](Severity severity) {
    return static_cast<std::uint64_t>(std::ranges::count(report.check.groups, severity, &FindingGroup::severity));
  };
  if (const auto errors = kinds(Severity::Error); errors > 0) {
    page.raw("<div class=\"verdict error\">").text(counted(errors, "error")).raw("</div>");
  } else if (const auto warnings = kinds(Severity::Warning); warnings > 0) {
    page.raw("<div class=\"verdict warning\">").text(counted(warnings, "warning")).raw("</div>");
  } else {
    page.raw("<div class=\"verdict good\">Nothing against it</div>");
  }
  page.raw("</header>\n");
}

void add_figures(Markup& page, const Report& report) {
  const JobEstimate& estimate = report.estimate;
  const PathSummary& path = report.path;
  page.raw("<dl class=\"figures\">\n");
  add_fact(page, "Time", clock_text(estimate.total_s),
           percent(estimate.use.cutting_s, estimate.total_s) + " of it cutting");
  add_fact(page, "Cuts", sizes(path.cuts),
           path.cuts.is_empty() ? "" : "down to Z " + paper_number(static_cast<double>(path.cuts.least_mm[2])) + " mm");
  add_fact(page, "Cutting distance", metres(estimate.cutting_mm), "and " + metres(estimate.rapid_mm) + " of rapids");
  std::string tools;
  for (const ToolUse& tool : path.tools | std::views::take(6)) {
    tools += (tools.empty() ? "T" : ", T") + std::to_string(tool.number);
  }
  const bool is_unnamed = path.tools.size() == 1 && path.tools.front().number == 0;
  add_fact(page, "Tools", std::to_string(path.tools.size()), is_unnamed ? "not numbered" : tools);
  page.raw("</dl>\n");
}

void add_pictures(Markup& page, const Report& report) {
  if (report.pictures.empty()) return;
  add_figure(page, report.pictures.front(), "hero");
  add_legend(page, report, colours_of(report));
  const auto rest = report.pictures | std::views::drop(1);
  if (rest.empty()) return;
  page.raw("<div class=\"views\">\n");
  add_figure(page, *rest.begin());
  page.raw("<div class=\"stack\">\n");
  for (const ReportPicture& picture : rest | std::views::drop(1)) add_figure(page, picture);
  page.raw("</div></div>\n");
}

void add_findings(Markup& page, const Report& report) {
  const CheckResult& check = report.check;
  page.raw("<h2>Findings</h2>\n");
  if (check.errors + check.warnings == 0) {
    page.raw("<p>")
        .text("Nothing that " + report.firmware + " would refuse, and nothing to be warned of.")
        .raw("</p>\n");
  }
  for (const FindingGroup& group : check.groups) {
    if (group.severity != Severity::Note) add_finding(page, group);
  }
  add_notes(page, check);
}

void add_times(Markup& page, const Report& report) {
  const JobEstimate& estimate = report.estimate;
  const auto shares = shares_of(estimate.use);
  page.raw("<h2>Time</h2>\n<div class=\"shares\">").svg(draw_shares(shares, kPage_px)).raw("</div>\n");
  page.raw("<ul class=\"legend\">\n");
  for (const Share& share : shares) {
    page.raw("<li><i style=\"background:" + css_colour(share.colour) + "\"></i>");
    page.text(share.name + " " + clock_text(share.seconds) + ", " + percent(share.seconds, estimate.total_s));
    page.raw("</li>\n");
  }
  page.raw("</ul>\n");
  if (!estimate.stops.empty()) {
    page.raw("<p>").text("It waits for the operator " +
                         (estimate.stops.size() == 1 ? "once" : std::to_string(estimate.stops.size()) + " times") +
                         "; the notes say where.");
    page.raw("</p>\n");
  }
  if (estimate.lines_answered < estimate.lines) {
    page.raw("<p class=\"bad\">")
        .text("It stops behind line " + std::to_string(estimate.lines_answered) + " of " +
              std::to_string(report.file.lines) + ": the time is that up to there.");
    page.raw("</p>\n");
  }
  if (estimate.feeds.size() > 1) {
    page.raw("<figure class=\"feeds\">").svg(draw_feeds(estimate.feeds, kPage_px)).raw("</figure>\n");
  }
}

void add_operations(Markup& page, const Report& report) {
  const auto& operations = report.estimate.operations;
  const auto is_named = [](const PartEstimate& part) { return !part.name.empty(); };
  if (std::ranges::none_of(operations, is_named)) return;
  const auto colours = colours_of(report);
  page.raw("<h2>Operations</h2>\n<table>\n");
  page.heads({"Operation", "#Lines", "#Cut", "#Time", "#Share", ""});
  for (const PartEstimate& part : operations | std::views::take(kMostRows)) {
    const std::string name = part.name.empty() ? "Before the first" : part.name;
    const auto row = std::ranges::find(colours.legend(), name, &LegendRow::name);
    const bool is_coloured = colours.by() == PlotColour::Operation && row != colours.legend().end();
    const Rgb colour = is_coloured ? row->colour : kPlain;
    page.raw("<tr><td class=\"name has-swatch\">");
    if (is_coloured) page.raw("<span class=\"swatch\" style=\"background:" + css_colour(colour) + "\"></span>");
    page.text(name).raw("</td>").cell(lines_text(part.first_line, part.last_line), "number");
    page.cell(metres(part.cutting_mm), "number");
    add_time_cells(page, &part, report.estimate.total_s, colour);
    page.raw("</tr>\n");
  }
  page.raw("</table>\n");
  if (operations.size() > kMostRows) {
    page.raw("<p class=\"soft\">")
        .text("and " + std::to_string(operations.size() - kMostRows) + " more.")
        .raw("</p>\n");
  }
}

void add_tools(Markup& page, const Report& report) {
  if (report.path.tools.empty()) return;
  page.raw("<h2>Tools</h2>\n<table>\n");
  page.heads({"Tool", "#From line", "#Feed, mm/min", "#Speed, rpm", "#Deepest Z, mm", "#Cut", "#Time", "#Share", ""});
  for (const ToolUse& tool : report.path.tools | std::views::take(kMostRows)) {
    const std::string name = "T" + std::to_string(tool.number);
    const PartEstimate* part = part_named(report.estimate.tools, name);
    if (part == nullptr) part = part_named(report.estimate.tools, "");
    page.raw("<tr>")
        .cell(tool.number == 0 ? kDash : std::string_view{name})
        .cell(std::to_string(tool.first_line), "number");
    page.cell(range(tool.feed_mm_per_min), "number").cell(range(tool.spindle_rpm), "number");
    page.cell(tool.cut_z_mm.is_empty() ? std::string{kDash} : paper_number(tool.cut_z_mm.least), "number");
    page.cell(metres(tool.cut_mm), "number");
    add_time_cells(page, part, report.estimate.total_s, kPlain);
    page.raw("</tr>\n");
  }
  page.raw("</table>\n");
}

void add_limits(Markup& page, const Report& report) {
  const CheckMachine& machine = report.machine;
  page.raw("<h2>Limits</h2>\n<table>\n");
  page.heads({"", "#Program, mm", "#Reach, mm", "#Machine travel, mm", "#Greatest rate, mm/min", ""});
  const PathBounds& bounds = report.path.bounds;
  for (std::size_t axis = 0; axis < 3 && !bounds.is_empty(); ++axis) {
    const auto& travel = machine.travel.at(axis);
    const double reach = static_cast<double>(bounds.size_mm(axis));
    const double room = travel ? static_cast<double>(travel->max_mm) - static_cast<double>(travel->min_mm) : 0;
    page.raw("<tr>").cell(std::string{vocabulary::kAxisLetters[axis]});
    page.cell(paper_number(static_cast<double>(bounds.least_mm.at(axis))) + " to " +
                  paper_number(static_cast<double>(bounds.most_mm.at(axis))),
              "number");
    page.cell(paper_number(reach), "number").cell(travel ? paper_number(room) : std::string{kDash}, "number");
    page.cell(paper_number(static_cast<double>(machine.motion.max_rate_mm_per_min.at(axis))), "number");
    const bool fits = reach <= room + 1e-3;
    page.cell(!travel ? "" : fits ? "fits" : "larger than the machine", fits ? "ok" : "bad").raw("</tr>\n");
  }
  page.raw("</table>\n<p class=\"soft\">").text("Program: from work zero, rapids included. ");
  if (!report.path.feed_mm_per_min.is_empty()) {
    page.text("Programmed feeds: " + range(report.path.feed_mm_per_min) + " mm/min. ");
  }
  if (!report.path.spindle_rpm.is_empty()) {
    page.text("Spindle: " + range(report.path.spindle_rpm) + " rpm");
    if (machine.spindle_rpm_max > 0) {
      page.text(" of " + paper_number(static_cast<double>(machine.spindle_rpm_min)) + " " + std::string{kDash} + " " +
                paper_number(static_cast<double>(machine.spindle_rpm_max)));
    }
    page.text(". ");
  }
  page.text(machine.guarded_axes != 0 ? "Soft limits are on."
                                      : "Soft limits are off: nothing stops the machine at its ends.");
  page.raw("</p>\n");
}

void add_file(Markup& page, const Report& report) {
  const PathSummary& path = report.path;
  const auto row = [&page](std::string_view name, std::string_view value, std::string_view kind = "name") {
    page.raw("<tr>").cell(name, "soft").cell(value, kind).raw("</tr>\n");
  };
  page.raw("<h2>File</h2>\n<table>\n");
  row("Name", report.file.name);
  row("Size", std::to_string(report.file.size_bytes) + " bytes, " + counted(report.file.lines, "line"));
  row("XXH3-128", report.file.hash);
  row("Units", path.uses_inches && path.uses_mm ? "inches and millimetres"
               : path.uses_inches               ? "inches (G20)"
                                                : "millimetres (G21)");
  row("Motion", counted(path.cut_count, "cut") + " (" + counted(path.arc_count, "arc") + "), " +
                    counted(path.rapid_count, "rapid"));
  row("Machine", report.firmware + " with " + report.settings);
  page.raw("</table>\n");
}

}  // namespace kerf::rehearsal
