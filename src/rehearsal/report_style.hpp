#pragma once
// How a report looks on a screen and on A4.

#include <string_view>

namespace kerf::rehearsal {

inline constexpr std::string_view kReportStyle = R"(
@page { size: A4; margin: 14mm 14mm 16mm;
  @bottom-right { content: counter(page) " / " counter(pages); font: 8pt system-ui, sans-serif; color: #66717d } }
* { box-sizing: border-box }
html { background: #eef1f4; -webkit-print-color-adjust: exact; print-color-adjust: exact }
body { margin: 0 auto; max-width: 860px; background: #fff; padding: 40px 48px 32px; color: #1f2933;
  font: 14px/1.45 system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif;
  font-variant-numeric: tabular-nums }
header { display: flex; justify-content: space-between; align-items: flex-start; gap: 24px }
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 4px; overflow-wrap: anywhere }
h2 { font-size: 16px; margin: 34px 0 10px; break-after: avoid }
p { margin: 0 0 8px }
.soft { color: #66717d }
.verdict { flex: none; border-radius: 999px; padding: 5px 14px; font-weight: 600; white-space: nowrap }
.good { background: #e3f4ea; color: #14663a }
.warning { background: #fdf0d5; color: #8a5600 }
.error { background: #fde4e1; color: #a61b1b }
.figures { display: grid; grid-template-columns: 1fr 1.8fr 1.3fr 1fr; margin: 22px 0 10px;
  border-top: 1px solid #e3e8ed;
  border-bottom: 1px solid #e3e8ed }
.figures div { padding: 12px 14px 12px 0 }
.figures dt { color: #66717d; font-size: 12px }
.figures dd { margin: 0; font-size: 19px; font-weight: 600; line-height: 1.25 }
.figures dd small { font-size: 12px; font-weight: 400; color: #66717d; display: block }
dl { margin: 0 }
figure { margin: 0; break-inside: avoid }
figure svg { display: block; width: 100%; height: auto }
figcaption { font-size: 12px; color: #66717d; margin-top: 4px }
.views { display: grid; grid-template-columns: 1fr 1fr; gap: 20px 28px; align-items: start; margin-top: 18px;
  break-inside: avoid }
.views .stack { display: grid; gap: 18px }
.legend { display: flex; flex-wrap: wrap; gap: 4px 20px; list-style: none; margin: 10px 0 0; padding: 0;
  font-size: 12.5px }
.legend li { display: flex; align-items: center; gap: 7px }
.legend i { flex: none; width: 20px; height: 3px; border-radius: 2px }
.legend i.dash { background: none !important; height: 0; border-top: 1.5px dashed #9aa5b1; border-radius: 0 }
.legend svg { width: 180px; height: auto } .legend svg.zero { width: 13px; height: 13px }
table { border-collapse: collapse; width: 100% }
th { text-align: left; font-size: 12px; font-weight: 500; color: #66717d; padding: 4px 14px 4px 0;
  vertical-align: bottom }
td { padding: 6px 14px 6px 0; border-top: 1px solid #e9edf1; vertical-align: top }
tr { break-inside: avoid }
table + p { margin-top: 8px }
th:last-child, td:last-child { padding-right: 0 }
.number { text-align: right; white-space: nowrap }
.bar { width: 90px } .bar svg { display: block; width: 90px; height: 8px; margin-top: 7px }
.has-swatch { position: relative; padding-left: 19px }
.swatch { position: absolute; left: 0; top: 11px; width: 10px; height: 10px; border-radius: 2px }
.name { overflow-wrap: anywhere }
.shares svg { display: block; width: 100%; height: 18px }
.feeds { margin-top: 20px } .feeds svg { display: block; width: 100%; height: auto }
.finding { break-inside: avoid; border-left: 4px solid #9aa5b1; padding: 2px 0 2px 14px; margin: 0 0 14px }
.finding.is-error { border-color: #c92a2a } .finding.is-warning { border-color: #e8930c }
.finding h3 { font-size: 14px; margin: 0 0 2px }
.finding h3 span { font-weight: 400; color: #66717d }
.finding ul { margin: 4px 0; padding: 0; list-style: none }
.finding li { margin: 3px 0 }
code { font: 12px/1.4 ui-monospace, 'DejaVu Sans Mono', Menlo, Consolas, monospace; background: #f3f5f7;
  padding: 1px 5px;
  border-radius: 3px; overflow-wrap: anywhere }
.notes td:first-child { width: 36% } .notes td:nth-child(2) { width: 18% }
.ok { color: #14663a } .bad { color: #a61b1b; font-weight: 600 }
footer { margin-top: 36px; padding-top: 10px; border-top: 1px solid #e3e8ed; font-size: 12px; color: #66717d }
@media (max-width: 640px) { body { padding: 20px } .figures { grid-template-columns: 1fr 1fr }
  .views { grid-template-columns: 1fr } }
@media print { .swatch { top: 8px } .bar svg { margin-top: 4px } .figures dd { font-size: 13pt }
  .figures dd small { font-size: 8pt }
  .legend { font-size: 8pt; gap: 2px 18px }
  .hero svg { width: auto; max-width: 100%; max-height: 98mm; margin: 0 auto }
  html, body { background: #fff } body { max-width: none; padding: 0; font-size: 9.5pt } h2 { margin-top: 22px }
  .views, .figures { break-inside: avoid } }
)";

}  // namespace kerf::rehearsal
