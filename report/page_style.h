// SPDX-License-Identifier: BSD-3-Clause
//
// How pages and plots look. Plots stand in pages and as files by themselves, which not only
// browsers draw: kSvgStyle keeps to what every reader of SVG knows. Pages: on a screen of any
// width, and on A4 paper.
#pragma once

#include <string_view>

namespace aphotic {

inline constexpr std::string_view kSvgStyle = R"(
svg text { fill: #1d2530; font-family: inherit; }
svg .title { font-size: 18px; font-weight: bold; }
svg .axis { font-size: 13px; }
svg .tick { font-size: 12px; fill: #5b6673; }
svg .label { font-size: 11px; paint-order: stroke; stroke: #ffffff; stroke-width: 3px;
  stroke-linejoin: round; }
svg .strong { font-weight: bold; }
svg .limit { fill: #a4262c; }
svg path, svg .frame { fill: none; }
svg .frame { stroke: #9aa3ad; stroke-width: 1; }
svg .grid { stroke: #e9ecef; stroke-width: 1; }
svg .guide { stroke: #8f9199; stroke-width: 1; stroke-dasharray: 4 4; }
svg .leader { stroke: #9aa3ad; stroke-width: 1; }
svg .curve { stroke: currentColor; stroke-width: 2; stroke-linejoin: round; }
svg .dashed { stroke-dasharray: 7 5; }
svg .reference { stroke: currentColor; stroke-opacity: 0.32; stroke-width: 6;
  stroke-linejoin: round; }
svg .rendered { stroke: currentColor; stroke-width: 1.6; stroke-dasharray: 7 5;
  stroke-linejoin: round; }
svg .dots { stroke: currentColor; stroke-width: 2.2; stroke-opacity: 0.75; }
svg .bound { stroke: #a4262c; stroke-width: 1.3; stroke-dasharray: 2 3; }
svg .front { stroke: #14181d; stroke-opacity: 0.28; stroke-width: 2.5; }
svg path.dot { fill: currentColor; stroke: currentColor; stroke-width: 1.6;
  stroke-linejoin: round; }
svg path.hollow { fill: #ffffff; }
)";

inline constexpr std::string_view kPageStyle = R"(
:root { --ink: #1d2530; --soft: #5b6673; --rule: #dfe3e8; --paper: #ffffff; --ground: #f5f4f1;
  --good: #1f6f43; --bad: #a4262c; }
* { box-sizing: border-box; }
html { background: var(--ground); -webkit-text-size-adjust: 100%; }
body { margin: 0; color: var(--ink); font: 16px/1.55 system-ui, -apple-system, "Segoe UI",
  Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans", Arial, sans-serif; }
main { max-width: 1160px; margin: 0 auto; padding: 48px 40px 64px; background: var(--paper); }
h1 { font-size: 34px; line-height: 1.2; font-weight: 650; margin: 0 0 20px;
  letter-spacing: -0.01em; overflow-wrap: anywhere; }
h2 { font-size: 22px; font-weight: 620; margin: 56px 0 14px; padding-top: 18px;
  border-top: 1px solid var(--rule); }
h3 { font-size: 16px; font-weight: 620; margin: 26px 0 8px; }
p { margin: 10px 0; max-width: 75ch; }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: 14px; margin-top: 6px; }
code, pre { font: 13px/1.5 ui-monospace, "DejaVu Sans Mono", "Liberation Mono", monospace; }
code { overflow-wrap: anywhere; }
pre { margin: 12px 0; padding: 14px 18px; background: var(--ground); border-radius: 3px;
  overflow-x: auto; unicode-bidi: plaintext; }
.eyebrow { margin: 0 0 4px; color: var(--soft); font-size: 13px; letter-spacing: 0.09em;
  text-transform: uppercase; }
.verdict { border-left: 5px solid; padding: 14px 20px; border-radius: 3px; }
.verdict p { margin: 0; color: var(--ink); max-width: none; }
.verdict .word { font-size: 20px; font-weight: 650; margin-bottom: 4px; }
.verdict.holds { border-color: var(--good); background: #eef6f1; }
.verdict.fails { border-color: var(--bad); background: #fbeeee; }
.holds .word { color: var(--good); }
.fails .word { color: var(--bad); }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 20px; }
.picture { display: block; width: 100%; height: auto; border-radius: 2px; }
.squares { image-rendering: pixelated; }
.map { position: relative; outline: 1px solid var(--rule); }
.map .marks { position: absolute; inset: 0; width: 100%; height: 100%; }
.legend { display: flex; flex-wrap: wrap; gap: 2px 22px; font-size: 14px; color: var(--soft);
  max-width: none; }
.key { display: inline-flex; align-items: center; gap: 6px; white-space: nowrap; }
.swatch { width: 13px; height: 13px; outline: 1px solid var(--rule); }
.stroke { width: 34px; height: 12px; color: var(--ink); }
.dot-key { width: 14px; height: 14px; }
.plot { margin: 6px 0 26px; }
.plot > svg { display: block; width: 100%; height: auto; }
.plot.narrow { display: none; }
svg .halo { fill: none; stroke: #ffffff; stroke-width: 5; vector-effect: non-scaling-stroke; }
svg .ring { fill: none; stroke: #14181d; stroke-width: 2; vector-effect: non-scaling-stroke; }
.rule { display: flex; flex-wrap: wrap; align-items: center; gap: 8px 56px; margin: 8px 0; }
.formula { font: 21px/1.4 "STIX Two Text", "Cambria", "Liberation Serif", "Times New Roman",
  serif; margin: 6px 0; }
.fraction { display: inline-block; vertical-align: middle; text-align: center; }
.fraction span { display: block; padding: 0 8px; }
.fraction span + span { border-top: 1.5px solid var(--ink); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 6px 24px; margin: 8px 0;
  max-width: 100ch; }
dt { color: var(--soft); max-width: 26ch; overflow-wrap: anywhere; }
dd { margin: 0; overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 13px;
  font-variant-numeric: tabular-nums; }
th, td { padding: 6px 5px; text-align: right; }
td, tbody th { white-space: nowrap; }
thead th { font-weight: 500; color: var(--soft); border-bottom: 1.5px solid var(--ink);
  vertical-align: bottom; }
tbody td, tbody th { border-bottom: 1px solid var(--rule); }
th:first-child { text-align: left; padding-left: 0; }
tbody th { font-weight: 620; }
th.mark, td.mark { text-align: left; }
td.mark { font-weight: 620; color: var(--good); }
tr.fails .mark { color: var(--bad); }
tr.fails { background: #fdf4f4; }
tr.against th, tr.against td { color: var(--soft); font-weight: 400; }
tr.best { background: #eef6f1; }
.numbered { display: grid; grid-template-columns: 2em 1fr; min-width: 196px;
  white-space: normal; }
.number { color: var(--soft); font-weight: 400; }
@media screen and (max-width: 1100px) {
  table, tbody { display: block; }
  thead { display: none; }
  tr { display: grid; grid-template-columns: repeat(auto-fill, minmax(100px, 1fr)); gap: 6px 12px;
    padding: 10px 6px; border-bottom: 1px solid var(--rule); }
  tbody th, tbody td { display: block; border: 0; padding: 0; text-align: left; }
  tbody th { white-space: normal; }
  tbody th, tbody td.mark { grid-column: 1 / -1; font-size: 15px; }
  tbody td.mark:empty { display: none; }
  tbody td:not(.mark)::before { content: attr(data-label); display: block; font-size: 12px;
    color: var(--soft); }
}
@media screen and (max-width: 760px) {
  main { padding: 24px 16px; }
  .pair { grid-template-columns: 1fr; }
  .plot.wide-plot { display: none; }
  .plot.narrow { display: block; max-width: 560px; margin-inline: auto; }
  .key { white-space: normal; }
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: 10px; }
}
@media print {
  @page { size: A4; margin: 14mm; }
  html { background: none; }
  body { font-size: 10pt; }
  main { padding: 0; max-width: none; }
  h1 { font-size: 20pt; }
  h2 { margin-top: 22pt; font-size: 14pt; break-after: avoid; }
  h3 { break-after: avoid; }
  figure, .map, .pair, .rule, p, dd, tr { break-inside: avoid; }
  pre { font-size: 8pt; white-space: pre-wrap; overflow-wrap: anywhere; }
  table { font-size: 6.6pt; }
  th, td { padding: 2pt 3pt; }
  .pair + p, .legend, figcaption { font-size: 8.5pt; }
  dl { gap: 3pt 16pt; max-width: none; }
  .wide { overflow: visible; }
  .verdict, .swatch, .picture, tr.fails, tr.best { print-color-adjust: exact;
    -webkit-print-color-adjust: exact; }
}
)";

}  // namespace aphotic
