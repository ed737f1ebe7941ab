#include "app/sweep/sheet/report_page.h"

namespace neve::app::sweep::sheet {

const char* const report_style = R"(
:root { color-scheme: light; }
body { font: 14px/1.45 "DejaVu Sans", Verdana, system-ui, sans-serif; color: #20262e;
  background: #fff; margin: 0 auto; max-width: 1480px; padding: 20px 28px 60px; }
h1 { font-size: 22px; margin: 0 0 2px; } h2 { font-size: 16px; margin: 34px 0 8px; }
p.sub { color: #5b6673; margin: 0 0 16px; } p.hint { color: #5b6673; margin: 0 0 6px; font-size: 12px; }
.sheet { position: relative; display: inline-block; max-width: 100%; }
.sheet img { display: block; max-width: 100%; height: auto; border-radius: 4px; }
.sheet a { position: absolute; border: 2px solid transparent; border-radius: 2px; box-sizing: border-box; }
.sheet a:hover, .sheet a.on { border-color: #ff8a4c; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 12.5px; font-variant-numeric: tabular-nums; }
th { text-align: right; cursor: pointer; padding: 4px 7px; border-bottom: 2px solid #aeb8c4;
  white-space: nowrap; user-select: none; background: #fff; position: sticky; top: 0; }
th.text, td.text { text-align: left; }
th[data-way="1"]::after { content: " \25B2"; font-size: 9px; }
th[data-way="-1"]::after { content: " \25BC"; font-size: 9px; }
#plots svg { display: block; max-width: 100%; }
td { text-align: right; padding: 3px 7px; border-bottom: 1px solid #e6eaef; white-space: nowrap; }
tr.failed td { background: #fff3ec; } td.warned { color: #a14a00; font-weight: bold; cursor: help; } tr.on td { background: #e4eefb; }
td.reason { white-space: normal; min-width: 220px; }
code { font: 12px "DejaVu Sans Mono", monospace; background: #f1f4f7; padding: 2px 5px; border-radius: 3px; }
button { font: inherit; font-size: 11px; border: 1px solid #c3ccd6; background: #fff; border-radius: 3px;
  cursor: pointer; padding: 1px 7px; margin-left: 6px; }
#parallel text { font-size: 11px; fill: #55606e; paint-order: stroke; stroke: #fff; stroke-width: 3px; } #parallel text.name { fill: #20262e; }
#parallel path { fill: none; stroke: #2b6cb0; stroke-width: 1.3; stroke-opacity: .45; }
#parallel path.failed { stroke: #d9561e; } #parallel path.on { stroke: #111; stroke-width: 2.6; stroke-opacity: 1; }
#parallel line { stroke: #aeb8c4; }
circle.on { stroke: #111; stroke-width: 2; }
)";

const char* const report_script = R"(
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const svgNS = "http://www.w3.org/2000/svg";
const make = (parent, name, attributes, text) => {
  const e = name.startsWith("svg:") ? document.createElementNS(svgNS, name.slice(4))
                                    : document.createElement(name);
  for (const key in attributes || {}) e.setAttribute(key, attributes[key]);
  if (text !== undefined) e.textContent = text;
  parent.appendChild(e);
  return e;
};
const short = x => {
  if (x === null || x === undefined) return "";
  if (typeof x !== "number") return x;
  if (Number.isInteger(x) && Math.abs(x) < 1e7) return String(x);
  return String(Number(x.toPrecision(4)));
};
// As written where it was given, rounded where it was measured.
const shown = (r, c) => c in r.texts ? r.texts[c] : short(r.cells[c]);
const mark = (run, on) => document.querySelectorAll('[data-run="' + run + '"]').forEach(
  e => e.classList.toggle("on", on));
const listen = (e, run) => {
  e.addEventListener("mouseenter", () => mark(run, true));
  e.addEventListener("mouseleave", () => mark(run, false));
};

// The table: a click on a head sorts by it, a second one backwards.
const head = make(document.getElementById("table"), "thead"), row = make(head, "tr");
const body = make(document.getElementById("table"), "tbody");
data.columns.forEach((column, c) => {
  const th = make(row, "th", {class: column.text ? "text" : ""}, column.title);
  if (column.help) th.title = column.help;
  th.addEventListener("click", () => {
    const way = th.dataset.way === "1" ? -1 : 1;
    row.querySelectorAll("th").forEach(other => delete other.dataset.way);
    th.dataset.way = way;
    const value = tr => data.rows[tr.dataset.at].cells[c];
    [...body.children].sort((a, b) => {
      const x = value(a), y = value(b), none = v => v === null || v === "";
      if (none(x) || none(y)) return none(x) - none(y);
      return way * (typeof x === "number" && typeof y === "number" ? x - y
                    : String(x).localeCompare(String(y), undefined, {numeric: true}));
    }).forEach(tr => body.appendChild(tr));
  });
});
data.rows.forEach((r, at) => {
  const tr = make(body, "tr", {"data-run": r.run, "data-at": at, id: "run-" + r.run,
                               class: r.failed ? "failed" : ""});
  r.cells.forEach((cell, c) => {
    const td = make(tr, "td", {class: data.columns[c].text ? "text" : ""}, shown(r, c));
    if (!data.columns[c].is_warning || cell === 0) return;
    td.title = r.warnings.join("\n");
    td.className = "warned";
  });
  listen(tr, r.run);
});
document.querySelectorAll(".sheet a, #plots circle").forEach(e => listen(e, e.dataset.run));

// Parallel coordinates: an axis for each column that says something.
const axes = data.columns.map((column, c) => {
  const values = data.rows.map(r => r.cells[c]).filter(v => v !== null && v !== "");
  const kinds = [...new Set(values)];
  if (!column.parallel || kinds.length < 2) return null;
  const numeric = values.every(v => typeof v === "number");
  if (!numeric && kinds.length > 12) return null;
  const low = Math.min(...values), high = Math.max(...values);
  return {title: column.title, c, kinds, numeric, low, high,
          at: v => numeric ? (v - low) / (high - low) : kinds.indexOf(v) / (kinds.length - 1)};
}).filter(a => a);
const step = 122, top0 = 34, height = 260;
const svg = document.getElementById("parallel");
svg.setAttribute("width", Math.max(1, axes.length) * step + 20);
svg.setAttribute("height", top0 + height + 26);
const x = k => 64 + k * step, y = part => top0 + height * (1 - part);
data.rows.forEach(r => {
  let path = "", pen = "M";
  axes.forEach((a, k) => {
    const v = r.cells[a.c];
    if (v === null || v === "") { pen = "M"; return; }
    path += pen + x(k) + " " + y(a.at(v)).toFixed(1);
    pen = "L";
  });
  const line = make(svg, "svg:path", {d: path, "data-run": r.run, class: r.failed ? "failed" : ""});
  make(line, "svg:title", {}, "run " + r.run + " " + r.label);
  listen(line, r.run);
});
axes.forEach((a, k) => {
  make(svg, "svg:line", {x1: x(k), x2: x(k), y1: top0, y2: top0 + height});
  make(svg, "svg:text", {x: x(k), y: 16, "text-anchor": "middle", class: "name"},
       a.title.length > 22 ? a.title.slice(0, 21) + "\u2026" : a.title);
  if (a.numeric) {
    const text = v => shown(data.rows.find(r => r.cells[a.c] === v), a.c);
    make(svg, "svg:text", {x: x(k) + 5, y: top0 + 4}, text(a.high));
    make(svg, "svg:text", {x: x(k) + 5, y: top0 + height + 4}, text(a.low));
  } else {
    a.kinds.forEach(kind => make(svg, "svg:text", {x: x(k) + 5, y: y(a.at(kind)) + 4},
                                 String(kind).slice(0, 18)));
  }
});

// Commands.
document.querySelectorAll("button[data-copy]").forEach(b => b.addEventListener("click", () => {
  navigator.clipboard && navigator.clipboard.writeText(b.dataset.copy);
  b.textContent = "copied";
}));
document.body.dataset.ready = "yes";
)";

}  // namespace neve::app::sweep::sheet
