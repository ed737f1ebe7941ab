// ---- points of several seeds: which differences are larger than noise -------------------------------
/** Runs of each point; they follow each other and differ in their seed alone. */
const seeds = sweep.seeds, hasSeeds = seeds > 1;
/** Tiles say how often the snow breaks, or what is predicted for full resolution. */
const hasSeals = hasSeeds || sweep.predicts;
const hasTwins = hasSeeds && sweep.predicts;  // coarse whiskers beside those of full resolution
const isPredicted = column => Boolean(column) && column.help.startsWith('full_');
const pointOf = at => Math.floor(at / seeds);
const drawOf = at => at % seeds;
/** The axis of the seeds, -1 without. */
const seedAxis = axes.findIndex(axis => axis.isSeed);

for (const own of sweep.noise || []) {
  const column = columns.find(c => c.kind === 'metric' && c.help === own.metric);
  column.isNoise = own.noise;
  column.isUnknown = !own.known;  // too few runs ended to say what is noise
  column.points = own.points;
}
const titleOf = column => column.title + (column.isNoise ? ': noise here' : '');
const noiseWords = 'noise here: the points differ by no more than runs with other seeds';
const unknownWords = 'no two points have ended, one of them with two seeds';

/** Mean, min and max of a metric at the point of a run; nothing where it has none, or no run tells. */
const summaryOf = (column, at) => column.points ? column.points[pointOf(at)] : null;

/** Two points that share a group are too close to call; false where one of them has no value. */
function isClose(column, a, b) {
  const x = summaryOf(column, a), y = summaryOf(column, b);
  return Boolean(x && y) && x.groups.some(group => y.groups.includes(group));
}

/** "0.42 (0.4 to 0.45) ab" */
function pointText(column, at) {
  const s = summaryOf(column, at);
  if (!s) return '';
  const range = s.min === s.max ? '' : ` (${roughText(s.min)} to ${roughText(s.max)})`;
  return roughText(Number(s.mean.toPrecision(4))) + range + (s.letters && !column.isNoise ? ' ' + s.letters : '');
}

/** "breaks in 1 of 4: here" */
function outcomeText(at) {
  const outcome = sweep.outcomes[pointOf(at)], {broken} = rows[at];
  if (sweep.predicts || !outcome.undecided || broken === null) return outcome.text;
  return outcome.text + (broken ? ': here' : ': not here');
}

/** The value that gives a run its colour: points that share a rank share it. No number: it has none. */
function colourValue(column, at) {
  if (!column.points) return isNaN(column.places[at]) ? NaN : rows[at].cells[column.at];
  const s = summaryOf(column, at);
  return s && column.isDrawn && !column.isNoise ? s.shared : NaN;
}

/** Its place from 0 to 1. */
function colourPlace(column, at) {
  if (!column.points) return column.places[at];
  const value = colourValue(column, at);
  return isNaN(value) ? NaN : column.scale.at(value);
}

/** A metric of coarse runs and of full resolution, on one scale; null where seeds give only one of them. */
function twinsOf(column) {
  if (!hasSeeds || !sweep.predicts || !column.points) return null;
  const name = isPredicted(column) ? column.help.slice('full_'.length) : 'full_' + column.help;
  const other = columns.find(c => c.points && c.help === name);
  if (!other) return null;
  const [coarse, full] = isPredicted(column) ? [other, column] : [column, other];
  const told = [...coarse.points, ...full.points].filter(point => point);
  const low = Math.min(...told.map(point => point.min)), high = Math.max(...told.map(point => point.max));
  return {coarse, full, place: x => high > low ? (x - low) / (high - low) : 0.5};
}

/** A line from min to max on a scale, that of its column without another, with a dot at the mean. */
function whiskerOf(column, at, scale) {
  const s = summaryOf(column, at), box = make('i', {className: 'whisker'});
  const place = scale || (column.scale && column.scale.at);
  if (!s || !place) return box;
  const [low, mean, high] = [s.min, s.mean, s.max].map(x => 100 * Math.max(0, Math.min(1, place(x))));
  const line = make('i'), dot = make('b');
  line.style.left = low + '%';
  line.style.width = high - low + '%';
  dot.style.left = mean + '%';
  box.append(line, dot);
  box.classList.toggle('noise', column.isNoise);
  box.title = column.title + ' ' + pointText(column, at);
  return box;
}

/** A square for each group of a point, in its colour; one for many. */
function lettersOf(column, summary) {
  if (column.isNoise) return [make('strong', {textContent: 'noise'})];
  const isMany = summary.groups.length > 3;
  return (isMany ? [summary.groups[0]] : summary.groups).map((group, k) => {
    const square = make('strong', {textContent: isMany ? summary.letters : [...summary.letters.match(/[a-z]\d*/g)][k]});
    square.style.background = `rgb(${sweep.groupColours[group % sweep.groupColours.length]})`;
    return square;
  });
}

/** The rank that orders points; those that are too close to call with each other keep their order. */
const rankOf = (column, at) => { const s = summaryOf(column, at); return s ? -s.rank : null; };

/** "They differ in spread. Too close to call: height." of two runs. */
function differenceText(a, b) {
  if (!hasSeals) return '';
  if (hasSeeds && pointOf(a) === pointOf(b)) return ' One point with two seeds: the difference is noise.';
  const both = measured.filter(c => summaryOf(c, a) && summaryOf(c, b));
  if (both.length > 0 && both.every(c => c.isUnknown)) return ` It is not known whether they differ: ${unknownWords}.`;
  const told = both.filter(c => !c.isNoise && !c.isUnknown);
  const names = list => list.map(c => c.title).join(', ');
  const close = told.filter(c => isClose(c, a, b)), apart = told.filter(c => !isClose(c, a, b));
  return (apart.length > 0 ? ` They differ in ${names(apart)}.` : ' No metric tells them apart.') +
    (close.length > 0 ? ` Too close to call: ${names(close)}.` : '');
}
