'use strict';
// ---- the sweep: columns, runs, axes. Nothing here draws. -----------------------------------------
const sweep = JSON.parse(document.getElementById('data').textContent);
const {columns, rows} = sweep;

const isGiven = value => value !== null && value !== undefined && value !== '';
const isNumber = value => typeof value === 'number';

/** A number with four digits, anything else as text. */
function roughText(value) {
  if (!isGiven(value)) return '';
  if (!isNumber(value)) return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
  return String(Number(value.toPrecision(4)));
}

/** As written where it was given, rounded where it was measured. */
function cellText(row, c) {
  return c in row.texts ? row.texts[c] : roughText(row.cells[c]);
}

/** [[0, 24], [30, 31]] as numbers of frames. */
function expandRanges(ranges) {
  const numbers = [];
  for (const [first, last] of ranges) for (let n = first; n <= last; ++n) numbers.push(n);
  return numbers;
}

rows.forEach((row, at) => {
  row.at = at;
  row.frames = expandRanges(row.frames);
  row.name = 'run ' + row.run + (row.label ? ' \u00b7 ' + row.label : '');
});
const frames = [...new Set(rows.flatMap(row => row.frames))].sort((a, b) => a - b);
if (frames.length === 0) frames.push(0);

// ---- scales --------------------------------------------------------------------------------------
/**
 * Places of a column's values from 0 to 1: logarithmic where they are positive and go over more than a
 * factor of 20, side by side where they are choices. Runs that did not end well do not stretch it.
 */
function makeScale(c) {
  const values = rows.map(row => row.cells[c]).filter(isGiven);
  const kinds = [...new Set(values)];
  if (kinds.length === 0) return null;
  if (!values.every(isNumber)) {
    return {isChoice: true, kinds, count: kinds.length,
            at: value => kinds.length > 1 ? (kinds.indexOf(value) + 0.5) / kinds.length : 0.5,
            text: place => String(kinds[Math.max(0, Math.min(kinds.length - 1,
                                                             Math.floor(place * kinds.length)))])};
  }
  const good = rows.filter(row => row.state === 'ok').map(row => row.cells[c]).filter(isGiven);
  const isMeasured = columns[c].kind === 'metric' && good.length > 0;
  // Intervals of predictions reach beyond the values.
  const own = (sweep.noise || []).find(noise => columns[c].kind === 'metric' && noise.metric === columns[c].help);
  const ends = own ? own.points.flatMap(point => point ? [point.min, point.max] : []) : [];
  const [low, high] = extent(isMeasured ? [...good, ...ends] : values);
  const isLog = low > 0 && high > 20 * low;
  const to = isLog ? Math.log : x => x, from = isLog ? Math.exp : x => x;
  const a = to(low), width = to(high) - a;
  // As many as tell one end, and a tenth of the way, from the other.
  const largest = Math.max(Math.abs(low), Math.abs(high));
  const digits = Math.min(15, Math.max(3, 2 + Math.ceil(Math.log10(largest / (high - low) || 1))));
  return {isChoice: false, isLog, low, high, count: kinds.length,
          at: x => {
            if (width <= 0) return 0.5;
            const place = (isLog && x <= 0 ? -1 : (to(x) - a) / width);
            return Math.max(-0.04, Math.min(1.04, place));
          },
          value: place => from(a + place * width),
          show: x => String(Number(x.toPrecision(digits))),
          text: place => String(Number(from(a + place * width).toPrecision(digits)))};
}

function extent(values) {
  let low = Infinity, high = -Infinity;
  for (const x of values) {
    if (x < low) low = x;
    if (x > high) high = x;
  }
  return [low, high];
}

columns.forEach((column, c) => {
  column.at = c;
  column.scale = makeScale(c);
  const count = column.scale ? column.scale.count : 0;
  const isDrawable = count > 1 && (!column.scale.isChoice || count <= 24);
  column.isDrawn = isDrawable && ['parameter', 'metric', 'state'].includes(column.kind);
  /** Of each run, 0 to 1; NaN where it has no value. */
  column.places = rows.map(
    row => column.isDrawn && isGiven(row.cells[c]) ? column.scale.at(row.cells[c]) : NaN);
});
const drawn = columns.filter(column => column.isDrawn);
const measured = drawn.filter(column => column.kind === 'metric');

// ---- axes ----------------------------------------------------------------------------------------
/**
 * An axis of the walk: stops with a text and a place from 0 to 1, and the stop of each run, -1 for
 * none.
 */
function makeAxis(name, stops, stopOf, isChoice) {
  return {name, texts: stops.map(stop => stop.text), places: stops.map(stop => stop.place), isChoice,
          stopOf};
}

/** Of the values of a column. */
function axisOfColumn(column) {
  const {scale} = column;
  const values = [...new Set(rows.map(row => row.cells[column.at]).filter(isGiven))];
  if (!scale.isChoice) values.sort((a, b) => a - b);
  const stops = values.map(value => ({
    text: cellText(rows.find(row => row.cells[column.at] === value), column.at), place: scale.at(value)}));
  return makeAxis(column.title, stops, rows.map(row => values.indexOf(row.cells[column.at])),
                  scale.isChoice);
}

/** Of a grid or a screening: the runs know their levels, and one axis may set several parameters. */
function axisOfLevels(axis, k) {
  const own = columns.filter(c => c.kind === 'parameter' && axis.addresses.includes(c.help));
  const single = own.length === 1 && own[0].scale && !own[0].scale.isChoice ? own[0] : null;
  const levels = [...new Set(rows.filter(row => row.levels.length > k).map(row => row.levels[k]))];
  levels.sort((a, b) => a - b);
  const stops = [], stopAt = new Map();
  levels.forEach((level, n) => {
    const row = rows.find(r => r.levels[k] === level);
    const text = axis.values[level] ?? own.map(column => cellText(row, column.at)).join(', ');
    const place = single ? single.scale.at(row.cells[single.at])
                         : levels.length > 1 ? n / (levels.length - 1) : 0.5;
    // A short list of choices has fewer values than a screening has levels.
    if (stops.length === 0 || stops[stops.length - 1].text !== text) stops.push({text, place});
    stopAt.set(level, stops.length - 1);
  });
  return makeAxis(axis.name || own.map(column => column.title).join(', '), stops,
                  rows.map(row => row.levels.length > k ? stopAt.get(row.levels[k]) : -1), !single);
}

function axisOfRuns() {
  const firsts = rows.filter(row => row.at % sweep.seeds === 0), last = Math.max(1, firsts.length - 1);
  const stops = firsts.map((row, k) => ({text: row.name, place: k / last}));
  return makeAxis('run', stops, rows.map((_, at) => Math.floor(at / sweep.seeds)), false);
}

/** Runs of a point, one after the other. */
function axisOfSeeds() {
  const column = columns.find(c => c.kind === 'seed');
  const stops = rows.slice(0, sweep.seeds).map((row, k) => (
    {text: cellText(row, column.at), place: k / (sweep.seeds - 1)}));
  return {...makeAxis('seed', stops, rows.map((_, at) => at % sweep.seeds), true), isSeed: true};
}

function makePointAxes() {
  const levelled = sweep.axes.map(axisOfLevels).filter(axis => axis.texts.length > 1);
  if (levelled.length > 0) return levelled;
  const varied = columns.filter(c => c.kind === 'parameter' && c.scale && c.scale.count > 1);
  return varied.length > 0 ? varied.map(axisOfColumn) : [axisOfRuns()];
}
const axes = makePointAxes();
if (sweep.seeds > 1) axes.push(axisOfSeeds());

/** A run that has a stop on every axis. */
const isOnAxes = at => axes.every(axis => axis.stopOf[at] >= 0);

/**
 * The run nearest to these stops: the least distance in shares of the axes; another choice is a whole
 * axis away.
 */
function nearestRun(stops) {
  let best = rows.findIndex(row => isOnAxes(row.at)), least = Infinity;
  for (let at = 0; at < rows.length; ++at) {
    let sum = 0;
    for (let k = 0; k < axes.length && sum < least; ++k) {
      const axis = axes[k], stop = axis.stopOf[at];
      if (stop < 0) sum = Infinity;
      else if (axis.isChoice) sum += stop === stops[k] ? 0 : 1;
      else sum += (axis.places[stop] - axis.places[stops[k]]) ** 2;
    }
    if (sum < least) {
      least = sum;
      best = at;
    }
  }
  return Math.max(0, best);
}

// ---- pictures and marks --------------------------------------------------------------------------
/** The last frame of a run up to this one; its first if that is later; undefined without pictures. */
function frameOf(row, frame) {
  let found = row.frames[0];
  for (const f of row.frames) if (f <= frame) found = f;
  return found;
}

/** The name of a picture as the folder has it: four places, of which a sign is one. */
const pictureName = frame =>
  (frame < 0 ? '-' + String(-frame).padStart(3, '0') : String(frame).padStart(4, '0')) + '.png';

function pictureOf(row, frame) {
  const f = frameOf(row, frame);
  return f === undefined ? '' : encodeURI(row.pictures) + pictureName(f);
}

/** True where a run ended before this frame. */
const isLate = (row, frame) => row.frames.length === 0 || row.frames[row.frames.length - 1] < frame;

const kindOf = row => row.failed ? 'failed' : row.state === 'ok' ? 'ok' : 'open';
