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
.sheet { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(320px, 100%), 1fr));
  gap: 22px 24px; margin-top: 16px; }
.duo { display: grid; grid-template-columns: 1fr 1fr; gap: 3px; }
.trio { grid-template-columns: 1fr 1fr 1fr; }
.sheet figcaption { overflow-wrap: anywhere; }
.picture { display: block; width: 100%; height: auto; border-radius: 2px; }
.squares { image-rendering: pixelated; }
.map { position: relative; outline: 1px solid var(--rule); }
.map .worst { position: absolute; width: 26px; height: 26px; border: 2px solid #14181d;
  border-radius: 50%; outline: 1.5px solid #ffffff; transform: translate(-50%, -50%); }
.legend { display: flex; flex-wrap: wrap; gap: 2px 22px; font-size: 14px; color: var(--soft);
  max-width: none; }
.key { display: inline-flex; align-items: center; gap: 6px; white-space: nowrap; }
.swatch { width: 13px; height: 13px; outline: 1px solid var(--rule); }
.stroke { width: 34px; height: 12px; color: var(--ink); }
.dot-key { width: 14px; height: 14px; }
.plot { margin: 6px 0 26px; }
.plot > svg { display: block; width: 100%; height: auto; }
svg .ring { fill: none; stroke: #14181d; stroke-width: 2; vector-effect: non-scaling-stroke; }
.formula { font: 21px/1.4 "STIX Two Text", "Cambria", "Liberation Serif", "Times New Roman",
  serif; margin: 6px 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 6px 24px; margin: 8px 0;
  max-width: 100ch; }
dt { color: var(--soft); max-width: 26ch; overflow-wrap: anywhere; }
dd { margin: 0; overflow-wrap: anywhere; }
.wide { overflow-x: auto; }
.plot.wide > svg { min-width: 720px; }
table { border-collapse: collapse; width: 100%; font-size: 13px;
  font-variant-numeric: tabular-nums; }
th, td { padding: 6px 5px; text-align: right; }
td { white-space: nowrap; }
thead th { font-weight: 500; color: var(--soft); border-bottom: 1.5px solid var(--ink);
  vertical-align: bottom; }
tbody td, tbody th { border-bottom: 1px solid var(--rule); }
th:first-child { text-align: left; padding-left: 0; }
tbody th { font-weight: 620; }
th.mark, td.mark { text-align: left; }
td.mark { font-weight: 620; color: var(--good); }
tr.fails .mark { color: var(--bad); }
tr.fails { background: #fdf4f4; }
tr.best { background: #eef6f1; }
@media screen and (max-width: 760px) {
  main { padding: 24px 16px; }
  .pair { grid-template-columns: 1fr; }
  .key { white-space: normal; }
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: 10px; }
}
@media print {
  @page { size: A4; margin: 14mm; }
  html { background: none; }
  body { font-size: 10pt; }
  main { padding: 0; max-width: none; }
  figure, .map, .pair, .duo, p, dd, tr { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; }
  table { font-size: 6.6pt; }
  .wide { overflow: visible; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)";

}  // namespace aphotic
