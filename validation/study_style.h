// SPDX-License-Identifier: BSD-3-Clause
//
// What a study's page looks like beyond a report's (report_style.h): the plot, and tables that turn
// into lists where a window is narrow.
#pragma once

#include <string_view>

namespace aphotic {

inline constexpr std::string_view kStudyStyle = R"(
svg .s0 { --tone: #2261a8; }
svg .s1 { --tone: #c5382f; }
svg .s2 { --tone: #238049; }
svg .s3 { --tone: #a8620f; }
svg .s4 { --tone: #7b3fa0; }
svg .s5 { --tone: #0b8590; }
svg .s6 { --tone: #5b6673; }
svg path.dot { fill: var(--tone); stroke: var(--tone); stroke-width: 1.6;
  stroke-linejoin: round; }
svg path.hollow { fill: #ffffff; }
svg .front { stroke: #14181d; stroke-opacity: 0.28; stroke-width: 2.5; }
svg .leader { stroke: #9aa3ad; stroke-width: 1; }
svg .label { font-size: 11px; paint-order: stroke; stroke: #ffffff; stroke-width: 3px;
  stroke-linejoin: round; }
svg .strong { font-weight: 650; }
svg text.limit { fill: var(--bad); }
.dot-key { width: 14px; height: 14px; }
.plot.narrow { display: none; }
.number { display: inline-block; width: 2em; margin-left: -2em; color: var(--soft);
  font-weight: 400; }
th:first-child { padding-left: 2em; }
tr.against th, tr.against td { color: var(--soft); font-weight: 400; }
tr.best { background: #eef6f1; }
td.mark { color: var(--good); white-space: nowrap; }
tbody th { white-space: normal; }
@media screen {
  th, td { padding: 6px 5px; }
  thead th:first-child { min-width: 196px; padding-left: 2em; }
  tbody th:first-child { padding-left: 2em; }
}
@media screen and (max-width: 760px) {
  .plot.wide-plot { display: none; }
  .plot.narrow { display: block; max-width: 560px; margin-inline: auto; }
  .key { white-space: normal; }
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: 8px; }
}
@media screen and (max-width: 1100px) {
  table, tbody { display: block; }
  thead { display: none; }
  tr { display: grid; grid-template-columns: repeat(auto-fill, minmax(100px, 1fr)); gap: 6px 12px;
    padding: 10px 6px; border-bottom: 1px solid var(--rule); }
  tbody th, tbody td { display: block; border: 0; padding: 0; text-align: left; }
  tbody th, tbody td.mark { grid-column: 1 / -1; font-size: 15px; }
  tbody td.mark:empty { display: none; }
  tbody td[data-label]::before { content: attr(data-label); display: block; font-size: 12px;
    color: var(--soft); }
}
)";

}  // namespace aphotic
