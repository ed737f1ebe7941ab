// ---- elements, state, painting -------------------------------------------------------------------
const by = id => document.getElementById(id);

/** An element with text; strangers' words come in as text alone, never as HTML. */
function make(name, properties = {}, ...children) {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
}

const markShapes = {ok: '<path d="M2 7l3 3 6-7"/>', failed: '<path d="M2.5 2.5l8 8M10.5 2.5l-8 8"/>',
                    open: '<path d="M6.5 2a4.5 4.5 0 1 0 .1 0z"/>'};

/** A sign of how a run ended, by its shape too. */
function markOf(row) {
  const mark = make('span');
  mark.innerHTML = `<svg class="mark ${kindOf(row)}" viewBox="0 0 13 13" role="img">` +
    markShapes[kindOf(row)] + '</svg>';
  mark.firstChild.setAttribute('aria-label', row.state);
  return mark.firstChild;
}

/** Shows this run, or -1, as the one below the pointer. */
function hover(at, x = 0, y = 0) {
  const tip = by('tip');
  tip.hidden = at < 0 || x === 0;
  if (!tip.hidden) placeTip(tipText(rows[at]), x, y);
  if (state.hover === at) return;
  state.hover = at;
  change('hover');
}

function tipText(row) {
  const lines = [row.name + (row.state === 'ok' ? '' : ': ' + row.state)];
  for (const column of columns)
    if (column.kind === 'parameter' && column.isDrawn)
      lines.push(column.title + ' = ' + cellText(row, column.at));
  return lines.slice(0, 9).join('\n');
}

function placeTip(text, x, y) {
  const tip = by('tip');
  tip.hidden = false;
  tip.textContent = text;
  const left = x + 14 + 260 > innerWidth ? Math.max(0, x - 14 - Math.min(260, x)) : x + 14;
  const top = Math.min(y + 14, innerHeight - 24 * text.split('\n').length);
  tip.style.transform = `translate(${left}px, ${top}px)`;
}

const state = {
  stops: axes.map(() => 0),  // of the sliders
  run: 0,                    // the run that is shown
  frame: frames[frames.length - 1],
  mode: 'one',
  pins: {a: -1, b: -1},
  hover: -1,
  brushes: new Map(),        // column -> [low, high] in places
  sort: {column: -1, way: 1},
  colour: measured.length > 0 ? (measured.find(column => !column.isNoise) || measured[0]).at : -1,
  kept: rows.map(row => row.at),  // by all brushes, sorted
  shown: [],                      // of those, the runs that have a tile: one of each point
  isKept: rows.map(() => true),
  onlyStars: false,
};

/**
 * Painters draw what changed, once a picture of the screen, and only what is in sight: a change to a
 * drawing that is scrolled away waits until somebody looks.
 */
const painters = [];
const changed = new Set();
let isAsked = false, isFirst = true;
const work = {paints: 0};  // how often something was drawn

/** @param parts names of changes that it needs; @param element whose sight counts, or nothing */
function addPainter(element, parts, paint) {
  const painter = {parts: new Set(parts), paint, waiting: new Set(parts), isSeen: !element};
  painters.push(painter);
  if (!element) return;
  new IntersectionObserver(entries => {
    painter.isSeen = entries[entries.length - 1].isIntersecting;
    if (painter.isSeen && painter.waiting.size > 0) ask();
  }, {rootMargin: '120px'}).observe(element);
}

function ask() {
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(paintAll);
}

/** @param parts star, run, draw, frame, mode, hover, brush, sort, colour, columns, size, scroll, peek, theme */
function change(...parts) {
  for (const part of parts) changed.add(part);
  ask();
}

function paintAll() {
  isAsked = false;
  if (changed.has('star') || changed.has('brush') || changed.has('sort') || changed.has('draw')) filterRuns();
  for (const painter of painters) {
    for (const part of changed) if (painter.parts.has(part)) painter.waiting.add(part);
    if (painter.waiting.size === 0 || !(painter.isSeen || isFirst)) continue;
    const parts = new Set(painter.waiting);
    painter.waiting.clear();
    painter.paint(parts);
    ++work.paints;
  }
  changed.clear();
  isFirst = false;
}

// ---- filter and order ----------------------------------------------------------------------------
function filterRuns() {
  const brushes = [...state.brushes];
  for (const row of rows)
    state.isKept[row.at] = (!state.onlyStars || row.mark.star) && brushes.every(([c, [low, high]]) => {
      const place = columns[c].places[row.at];
      return place >= low && place <= high;
    });
  state.kept = rows.filter(row => state.isKept[row.at]).map(row => row.at);
  sortRuns();
  showPoints();
}

/** One run of each point: that of the seed on the slider, or the first that is kept. */
function showPoints() {
  state.shown = state.kept;
  if (!hasSeeds) return;
  const draw = state.stops[seedAxis], points = new Map();
  for (const at of state.kept)
    if (!points.has(pointOf(at)) || drawOf(at) === draw) points.set(pointOf(at), at);
  state.shown = [...points.values()];
}

function sortRuns() {
  const {column, way} = state.sort;
  if (column < 0) return;
  // A difference within noise is no reason for an order.
  const isRanked = columns[column].points;
  const cell = at => isRanked ? columns[column].isNoise ? null : rankOf(columns[column], at)
                              : rows[at].cells[column];
  state.kept.sort((a, b) => {
    const x = cell(a), y = cell(b);
    if (!isGiven(x) || !isGiven(y)) return isGiven(y) - isGiven(x);
    return way * (isNumber(x) && isNumber(y) ? x - y
                  : String(x).localeCompare(String(y), undefined, {numeric: true}));
  });
}

/** @param range in places of the column's scale, or null */
function setBrush(c, range) {
  if (range) state.brushes.set(c, range);
  else state.brushes.delete(c);
  change('brush');
}

function rangeText(c, [low, high]) {
  const {scale, title} = columns[c];
  if (!scale.isChoice)
    return title + ' ' + scale.text(Math.max(0, low)) + ' to ' + scale.text(Math.min(1, high));
  return title + ' ' + scale.kinds.filter(kind => scale.at(kind) >= low && scale.at(kind) <= high).join(', ');
}

/** A place for a number or a choice as somebody types it; nothing where it is neither. */
function placeOfText(scale, text) {
  if (!scale.isChoice) return text.trim() === '' || isNaN(text) ? undefined : scale.at(Number(text));
  return scale.kinds.includes(text) ? scale.at(text) : undefined;
}

function startFilter() {
  const column = by('filter-column');
  for (const c of drawn) column.append(make('option', {value: c.at, textContent: titleOf(c)}));
  by('filter-form').addEventListener('submit', event => {
    event.preventDefault();
    const {scale, at} = columns[column.value];
    const low = placeOfText(scale, by('filter-low').value) ?? -1;
    const high = placeOfText(scale, by('filter-high').value) ?? (scale.isChoice && low >= 0 ? low : 2);
    const room = 1e-9;
    setBrush(at, [Math.min(low, high) - room, Math.max(low, high) + room]);
  });
  addPainter(null, ['brush'], () => {
    by('count').textContent = state.kept.length === rows.length ? rows.length + ' runs'
      : state.kept.length + ' of ' + rows.length + ' runs';
    if (hasSeeds) by('count').textContent += ` of ${state.shown.length} points`;
    const chips = [...state.brushes].map(([c, range]) => make('button', {
      type: 'button', textContent: rangeText(c, range) + ' \u2715', title: 'drop this filter',
      onclick: () => setBrush(c, null)}));
    if (chips.length > 1)
      chips.push(make('button', {type: 'button', textContent: 'all runs', onclick: () => {
        state.brushes.clear();
        change('brush');
      }}));
    by('brushes').replaceChildren(...chips);
  });
}

// ---- copying -------------------------------------------------------------------------------------
/** Also where a page from a file may not use the clipboard. */
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = make('textarea', {value: text});
    document.body.append(area);
    area.select();
    const isCopied = document.execCommand('copy');
    area.remove();
    return isCopied;
  }
}

async function copyFrom(button) {
  const isCopied = await copyText(button.dataset.copy);
  button.textContent = isCopied ? 'copied' : 'copy failed';
  setTimeout(() => { button.textContent = 'copy'; }, 1500);
}

function copyButton(text, title) {
  const button = make('button', {type: 'button', textContent: 'copy', title});
  button.setAttribute('aria-label', title);
  button.dataset.copy = text;
  return button;
}

// ---- colours -------------------------------------------------------------------------------------
/** Blue, green, yellow: legible on white and on black, and no red, which failures have. */
const ramp = [[47, 95, 208], [36, 148, 190], [70, 176, 130], [150, 190, 70], [232, 185, 60]];

function rampColour(place) {
  const t = Math.max(0, Math.min(1, place)) * (ramp.length - 1), k = Math.min(ramp.length - 2, Math.floor(t));
  return `rgb(${ramp[k].map((x, i) => Math.round(x + (ramp[k + 1][i] - x) * (t - k))).join(' ')})`;
}

let theme = {};
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ['page', 'card', 'ink', 'soft', 'line', 'strong', 'accent', 'bad', 'faint', 'brush'])
    theme[name] = style.getPropertyValue('--' + name).trim();
}

/** Of a run in drawings; failed ones have theirs whatever they measured. */
function colourOf(at) {
  if (rows[at].failed) return theme.bad;
  const place = state.colour < 0 ? NaN : colourPlace(columns[state.colour], at);
  return isNaN(place) ? theme.soft : rampColour(place);
}
