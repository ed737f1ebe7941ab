// ---- drawings ------------------------------------------------------------------------------------
/** The canvases of a drawing, with their size kept: asking for it at each drawing costs a layout. */
function watchCanvas(element) {
  const canvases = [...element.querySelectorAll('canvas')];
  const drawing = {element, canvases, width: element.clientWidth, height: element.clientHeight};
  new ResizeObserver(() => {
    drawing.width = element.clientWidth;
    drawing.height = element.clientHeight;
    change('size');
  }).observe(element);
  return drawing;
}

/** An empty canvas in pixels of the page, sharp on any screen. */
function penOf(drawing, layer) {
  const canvas = drawing.canvases[layer], ratio = devicePixelRatio || 1;
  const width = Math.round(drawing.width * ratio), height = Math.round(drawing.height * ratio);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  const pen = canvas.getContext('2d');
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, drawing.width, drawing.height);
  pen.font = '11px "DejaVu Sans", Verdana, system-ui, sans-serif';
  pen.lineJoin = 'round';
  return pen;
}

/** Breaks words into lines of a width; the last line takes the rest. */
function linesOf(pen, text, width, most) {
  const lines = [''];
  for (const word of text.slice(0, 120).split(/(?<=[ _])/)) {
    const last = lines.length - 1, longer = lines[last] + word;
    if (lines[last] === '' || lines.length === most || pen.measureText(longer).width <= width)
      lines[last] = longer;
    else lines.push(word);
  }
  return lines;
}

/** Text cut to a width, its last line at y; with the page's colour behind it if lines are below. */
function drawText(pen, text, x, y, width, options = {}) {
  const {align = 'left', colour = theme.soft, most = 1, isBacked = false} = options;
  pen.textAlign = align;
  const lines = linesOf(pen, text, width, most);
  lines.forEach((line, k) => {
    let shown = line;
    for (let n = line.length - 1; n > 0 && pen.measureText(shown).width > width; --n)
      shown = line.slice(0, n) + '\u2026';
    const base = y + 13 * (k - lines.length + 1), long = pen.measureText(shown).width;
    if (isBacked) {
      const left = {left: x, center: x - long / 2, right: x - long}[align];
      pen.fillStyle = theme.page;
      pen.globalAlpha = 0.8;
      pen.fillRect(left - 2, base - 10, long + 4, 13);
      pen.globalAlpha = 1;
    }
    pen.fillStyle = colour;
    pen.fillText(shown, x, base);
  });
}

/** Pointer of a drawing: moves, drags and taps, in its pixels. A drag is more than 4 pixels. */
function listenToPointer(element, {move, start, drag, end, tap, leave}) {
  let origin = null, isDrag = false;
  const at = event => {
    const box = element.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top, page: event};
  };
  element.addEventListener('pointerdown', event => {
    if (event.button !== 0) return;
    origin = at(event);
    isDrag = false;
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener('pointermove', event => {
    const place = at(event);
    if (!origin) return move && move(place);
    if (!isDrag && Math.hypot(place.x - origin.x, place.y - origin.y) > 4) {
      isDrag = true;
      if (start) start(origin);
    }
    if (isDrag && drag) drag(place, origin);
  });
  const finish = event => {
    if (origin && !isDrag && event.type === 'pointerup' && tap) tap(origin);
    if (isDrag && end) end();
    origin = null;
  };
  element.addEventListener('pointerup', finish);
  element.addEventListener('pointercancel', finish);
  element.addEventListener('pointerleave', event => { if (!origin && leave) leave(event); });
}

const clamp01 = x => Math.max(0, Math.min(1, x));

/** A cross for a run that failed, a disc for another. */
function drawPoint(pen, at, x, y, radius) {
  if (!rows[at].failed) {
    pen.beginPath();
    pen.arc(x, y, radius, 0, 7);
    pen.fill();
    return;
  }
  pen.beginPath();
  pen.moveTo(x - radius, y - radius);
  pen.lineTo(x + radius, y + radius);
  pen.moveTo(x + radius, y - radius);
  pen.lineTo(x - radius, y + radius);
  pen.stroke();
}

// ---- colour --------------------------------------------------------------------------------------
function startColour() {
  const select = by('colour');
  for (const column of drawn)
    if (!column.scale.isChoice) select.append(make('option', {value: column.at, textContent: titleOf(column)}));
  select.value = state.colour;
  select.closest('label').hidden = select.options.length === 0;
  select.addEventListener('change', () => {
    state.colour = Number(select.value);
    change('colour');
  });
  const canvas = by('legend');
  canvas.hidden = state.colour < 0;
  const drawing = {canvases: [canvas], width: 150, height: 26};
  addPainter(null, ['colour', 'theme'], () => {
    if (state.colour < 0) return;
    const pen = penOf(drawing, 0), {scale, isNoise} = columns[state.colour];
    for (let x = 0; x < 150; ++x) {
      pen.fillStyle = isNoise ? theme.soft : rampColour(x / 149);
      pen.fillRect(x, 0, 1.5, 10);
    }
    drawText(pen, scale.text(0), 0, 23, 70);
    drawText(pen, scale.text(1), 150, 23, 70, {align: 'right'});
  });
}

// ---- parallel coordinates ------------------------------------------------------------------------
const parallel = {shown: [], lines: []};

/** As many as the width has room for; the parameters first. */
function firstColumns(width) {
  const room = width < 600 ? 7 : Math.max(3, Math.floor(width / 88));
  const order = [...drawn.filter(c => c.kind === 'parameter'), ...drawn.filter(c => c.kind === 'state'),
                 ...measured];
  const chosen = new Set(order.slice(0, room));
  return drawn.filter(column => chosen.has(column));
}

/** Axes stand side by side, or below each other where the page is narrow. */
function parallelPlace(drawing, k, place) {
  if (parallel.isTall) return [16 + place * (drawing.width - 32), 30 + k * parallel.step];
  return [parallel.step * (k + 0.5), 58 + (1 - place) * (drawing.height - 80)];
}

function layoutParallel(drawing) {
  const count = Math.max(1, parallel.shown.length);
  parallel.isTall = drawing.width < 600;
  parallel.step = parallel.isTall ? 54 : drawing.width / count;
  const height = parallel.isTall ? 54 * count + 4 : 350;
  if (drawing.height !== height) {
    drawing.element.style.height = height + 'px';
    drawing.height = height;
  }
  drawing.element.style.touchAction = parallel.isTall ? 'pan-y' : 'none';
  parallel.lines = rows.map(row => {
    const points = [];
    parallel.shown.forEach((column, k) => {
      const place = column.places[row.at];
      points.push(isNaN(place) ? null : parallelPlace(drawing, k, place));
    });
    return points;
  });
}

function traceLine(pen, points) {
  let isDown = false;
  for (const point of points) {
    if (point && isDown) pen.lineTo(point[0], point[1]);
    else if (point) pen.moveTo(point[0], point[1]);
    isDown = point !== null;
  }
}

function drawParallelLines(pen) {
  pen.lineWidth = 1;
  pen.strokeStyle = theme.faint;
  pen.globalAlpha = 0.45;
  pen.beginPath();
  for (const row of rows) if (!state.isKept[row.at]) traceLine(pen, parallel.lines[row.at]);
  pen.stroke();
  pen.lineWidth = state.kept.length > 150 ? 1 : 1.4;  // hairlines are drawn several times faster
  pen.globalAlpha = state.kept.length > 150 ? 0.5 : 0.8;
  for (const at of state.kept) {
    pen.strokeStyle = colourOf(at);
    pen.setLineDash(rows[at].failed ? [5, 4] : []);
    pen.beginPath();
    traceLine(pen, parallel.lines[at]);
    pen.stroke();
  }
  pen.setLineDash([]);
  pen.globalAlpha = 1;
}

function drawParallelAxis(pen, drawing, column, k) {
  const [x0, y0] = parallelPlace(drawing, k, 0), [x1, y1] = parallelPlace(drawing, k, 1);
  pen.strokeStyle = theme.strong;
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
  const brush = state.brushes.get(column.at);
  if (brush) {
    const [a, b] = brush.map(place => parallelPlace(drawing, k, clamp01(place)));
    pen.fillStyle = theme.brush;
    pen.strokeStyle = theme.accent;
    const box = parallel.isTall ? [a[0] - 1, y0 - 8, b[0] - a[0] + 2, 16]
                                : [x0 - 8, b[1] - 1, 16, a[1] - b[1] + 2];
    pen.fillRect(...box);
    pen.strokeRect(...box);
  }
  drawParallelWords(pen, column, [x0, y0], [x1, y1]);
}

function drawParallelWords(pen, column, [x0, y0], [x1, y1]) {
  const {scale} = column, title = titleOf(column), room = parallel.isTall ? x1 - x0 : parallel.step - 8;
  if (parallel.isTall) {
    const low = scale.isChoice ? scale.kinds[0] : scale.text(0);
    const high = scale.isChoice ? scale.kinds[scale.kinds.length - 1] : scale.text(1);
    drawText(pen, title, (x0 + x1) / 2, y0 - 12, room * 0.56,
             {align: 'center', colour: column.isNoise ? theme.strong : theme.ink, isBacked: true});
    drawText(pen, low, x0 - 8, y0 - 12, room * 0.2, {isBacked: true});
    drawText(pen, high, x1 + 8, y0 - 12, room * 0.2, {align: 'right', isBacked: true});
    return;
  }
  drawText(pen, title, x0, 30, room,
           {align: 'center', colour: column.isNoise ? theme.strong : theme.ink, most: 2});
  const words = scale.isChoice ? scale.kinds.map(kind => [String(kind), scale.at(kind)])
                               : [[scale.text(0), 0], [scale.text(1), 1]];
  for (const [word, place] of words) {
    const y = y0 + (y1 - y0) * place + (scale.isChoice ? 4 : place === 0 ? 18 : -3);
    if (scale.isChoice) drawText(pen, word, x0 + 6, y, room * 0.75, {isBacked: true});
    else drawText(pen, word, x0, y, room, {align: 'center', isBacked: true});
  }
}

/** The axis below the pointer and the place on it. */
function parallelAxisAt(drawing, {x, y}) {
  const k = Math.max(0, Math.min(parallel.shown.length - 1,
    parallel.isTall ? Math.round((y - 30) / parallel.step) : Math.floor(x / parallel.step)));
  const [x0, y0] = parallelPlace(drawing, k, 0), [x1, y1] = parallelPlace(drawing, k, 1);
  const place = parallel.isTall ? (x - x0) / (x1 - x0) : (y - y0) / (y1 - y0);
  const away = parallel.isTall ? Math.abs(y - y0) : Math.abs(x - x0);
  return {k, place, away, length: parallel.isTall ? x1 - x0 : y0 - y1};
}

function distanceToLine({x, y}, points) {
  let least = Infinity;
  for (let k = 0; k + 1 < points.length; ++k) {
    if (!points[k] || !points[k + 1]) continue;
    const [ax, ay] = points[k], dx = points[k + 1][0] - ax, dy = points[k + 1][1] - ay;
    const t = clamp01(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1));
    least = Math.min(least, Math.hypot(ax + t * dx - x, ay + t * dy - y));
  }
  return least;
}

/** The kept run whose line or point is nearest, -1 beyond so many pixels. */
function nearestDrawn(distance, most) {
  let best = -1, least = most;
  for (const at of state.kept) {
    const d = distance(at);
    if (d < least) [least, best] = [d, at];
  }
  return best;
}

/** Which end of a brush a drag moves, or all of it, or a new one. */
function grabBrush(drawing, origin) {
  const {k, place, length} = parallelAxisAt(drawing, origin), c = parallel.shown[k].at;
  const brush = state.brushes.get(c), edge = 7 / length;
  if (!brush) return {k, c, fixed: place};
  if (Math.abs(place - brush[0]) < edge) return {k, c, fixed: brush[1]};
  if (Math.abs(place - brush[1]) < edge) return {k, c, fixed: brush[0]};
  if (place > brush[0] && place < brush[1]) return {k, c, whole: brush, from: place};
  return {k, c, fixed: place};
}

/** Where a drag along the axis has come to: another place of the same axis. */
function dragBrush(drawing, grabbed, {x, y}) {
  const [x0, y0] = parallelPlace(drawing, grabbed.k, 0), [x1, y1] = parallelPlace(drawing, grabbed.k, 1);
  const free = parallel.isTall ? (x - x0) / (x1 - x0) : (y - y0) / (y1 - y0);
  const place = Math.max(-0.05, Math.min(1.05, free));
  if (grabbed.whole) {
    const by = free - grabbed.from;
    setBrush(grabbed.c, [grabbed.whole[0] + by, grabbed.whole[1] + by]);
  } else {
    setBrush(grabbed.c, [Math.min(grabbed.fixed, place), Math.max(grabbed.fixed, place)]);
  }
}

/** Boxes to tick: which columns the drawing has. */
function startParallelColumns() {
  const box = document.querySelector('#parallel-columns div');
  for (const column of drawn) {
    const check = make('input', {type: 'checkbox', checked: parallel.shown.includes(column)});
    check.addEventListener('change', () => {
      const wanted = new Set(parallel.shown);
      if (check.checked) wanted.add(column);
      else wanted.delete(column);
      parallel.shown = drawn.filter(other => wanted.has(other));
      change('columns');
    });
    box.append(make('label', {}, check, ' ' + column.title));
  }
}

/** The shown run and the one below the pointer, thick, on a canvas of their own. */
function drawParallelLit(drawing) {
  const pen = penOf(drawing, 1);
  for (const [at, colour] of [[state.run, theme.accent], [state.hover, theme.ink]]) {
    if (at < 0) continue;
    pen.strokeStyle = colour;
    pen.lineWidth = 3;
    pen.beginPath();
    traceLine(pen, parallel.lines[at]);
    pen.stroke();
  }
}

function startParallel() {
  const drawing = watchCanvas(by('parallel'));
  parallel.shown = firstColumns(drawing.width);
  drawing.element.closest('section').hidden = drawn.length === 0;
  startParallelColumns();
  addPainter(drawing.element, ['brush', 'colour', 'columns', 'size', 'theme'], parts => {
    if (parts.has('columns') || parts.has('size')) layoutParallel(drawing);
    const pen = penOf(drawing, 0);
    drawParallelLines(pen);
    parallel.shown.forEach((column, k) => drawParallelAxis(pen, drawing, column, k));
  });
  addPainter(drawing.element, ['run', 'hover', 'columns', 'size', 'theme'],
             () => drawParallelLit(drawing));
  let grabbed = null;
  const nearest = place => nearestDrawn(at => distanceToLine(place, parallel.lines[at]), 9);
  listenToPointer(drawing.element, {
    move: place => hover(nearest(place), place.page.clientX, place.page.clientY),
    leave: () => hover(-1),
    start: origin => {
      hover(-1);
      grabbed = parallel.shown.length > 0 ? grabBrush(drawing, origin) : null;
    },
    drag: place => { if (grabbed) dragBrush(drawing, grabbed, place); },
    tap: place => {
      if (parallel.shown.length === 0) return;
      const {k, away} = parallelAxisAt(drawing, place), at = nearest(place);
      if (away < 12 && state.brushes.has(parallel.shown[k].at)) setBrush(parallel.shown[k].at, null);
      else if (at >= 0) goTo(at);
    },
  });
}

// ---- scatter plot --------------------------------------------------------------------------------
const scatter = {x: -1, y: -1};

/** Room for words at the left and below. */
const scatterBox = drawing => ({x: 58, y: 8, width: drawing.width - 70, height: drawing.height - 52});

function scatterPoint(box, at) {
  const x = columns[scatter.x].places[at], y = columns[scatter.y].places[at];
  return isNaN(x) || isNaN(y) ? null : [box.x + x * box.width, box.y + (1 - y) * box.height];
}

function drawFrame(pen, box) {
  pen.fillStyle = theme.card;
  pen.fillRect(box.x, box.y, box.width, box.height);
}

/** Values along an edge, the kinds of a choice or five numbers. */
function ticksOf(scale) {
  if (scale.isChoice) return scale.kinds.slice(0, 12).map(kind => [scale.at(kind), String(kind)]);
  return [0, 0.25, 0.5, 0.75, 1].map(place => [place, scale.text(place)]);
}

function drawScatterWords(pen, box) {
  const across = columns[scatter.x], up = columns[scatter.y];
  pen.strokeStyle = theme.line;
  pen.lineWidth = 1;
  for (const [place, text] of ticksOf(across.scale)) {
    const x = box.x + place * box.width, room = box.width / ticksOf(across.scale).length;
    pen.strokeRect(x, box.y, 0, box.height);
    drawText(pen, text, x, box.y + box.height + 22, room - 4, {align: 'center'});
  }
  for (const [place, text] of ticksOf(up.scale)) {
    const y = box.y + (1 - place) * box.height;
    pen.strokeRect(box.x, y, box.width, 0);
    drawText(pen, text, box.x - 5, y + 4, box.x - 8, {align: 'right'});
  }
  drawText(pen, across.title, box.x + box.width / 2, box.y + box.height + 40, box.width,
           {align: 'center', colour: theme.ink});
}

/** From min to max of each point, up and across, through its mean. */
function drawScatterWhiskers(pen, box) {
  const across = columns[scatter.x], up = columns[scatter.y];
  const ends = (column, at) => {
    const s = summaryOf(column, at);
    return s ? [s.min, s.mean, s.max].map(x => clamp01(column.scale.at(x))) : Array(3).fill(column.places[at]);
  };
  pen.lineWidth = 1.6;
  for (const at of state.shown) {
    const x = ends(across, at), y = ends(up, at);
    if ([...x, ...y].some(isNaN)) continue;
    const left = k => box.x + x[k] * box.width, top = k => box.y + (1 - y[k]) * box.height;
    pen.strokeStyle = pen.fillStyle = colourOf(at);
    pen.beginPath();
    pen.moveTo(left(0), top(1));
    pen.lineTo(left(2), top(1));
    pen.moveTo(left(1), top(0));
    pen.lineTo(left(1), top(2));
    pen.stroke();
    pen.fillRect(left(1) - 4, top(1) - 4, 8, 8);
  }
}

function drawScatterPoints(pen, box) {
  const radius = hasSeeds ? 2.4 : rows.length > 200 ? 3 : 4.2;
  pen.lineWidth = 1.8;
  for (const isKept of [false, true])
    for (const row of rows) {
      if (state.isKept[row.at] !== isKept) continue;
      const point = scatterPoint(box, row.at);
      if (!point) continue;
      pen.fillStyle = pen.strokeStyle = isKept ? colourOf(row.at) : theme.faint;
      drawPoint(pen, row.at, point[0], point[1], isKept ? radius : radius * 0.7);
    }
}

function drawScatterBrush(pen, box) {
  const x = state.brushes.get(scatter.x), y = state.brushes.get(scatter.y);
  if (!x && !y) return;
  const [x0, x1] = (x || [0, 1]).map(clamp01), [y0, y1] = (y || [0, 1]).map(clamp01);
  const place = [box.x + x0 * box.width, box.y + (1 - y1) * box.height, (x1 - x0) * box.width,
                 (y1 - y0) * box.height];
  pen.fillStyle = theme.brush;
  pen.strokeStyle = theme.accent;
  pen.lineWidth = 1;
  pen.fillRect(...place);
  pen.strokeRect(...place);
}

/** Rings about the shown run and the one below the pointer. */
function drawScatterLit(drawing) {
  const pen = penOf(drawing, 1), box = scatterBox(drawing);
  for (const [at, colour] of [[state.run, theme.accent], [state.hover, theme.ink]]) {
    const point = at >= 0 && scatterPoint(box, at);
    if (!point) continue;
    pen.strokeStyle = colour;
    pen.lineWidth = 2.5;
    pen.beginPath();
    pen.arc(point[0], point[1], 7.5, 0, 7);
    pen.stroke();
  }
}

function fillSelect(select, options, value, onChange) {
  for (const [key, text] of options) select.append(make('option', {value: key, textContent: text}));
  select.value = value;
  select.addEventListener('change', () => onChange(Number(select.value)));
}

function startScatter() {
  if (drawn.length < 2) {
    by('scatter').closest('section').hidden = true;
    return;
  }
  const options = drawn.map(c => [c.at, c.title]);
  scatter.x = (drawn.find(c => c.kind === 'parameter') || drawn[0]).at;
  const isOther = c => c.at !== scatter.x;
  scatter.y = (measured.find(isOther) || drawn.find(c => isOther(c) && !c.scale.isChoice) ||
               drawn.find(isOther)).at;
  const drawing = watchCanvas(by('scatter'));
  drawing.element.style.touchAction = 'pan-y';
  fillSelect(by('scatter-x'), options, scatter.x, c => { scatter.x = c; change('scatter'); });
  fillSelect(by('scatter-y'), options, scatter.y, c => { scatter.y = c; change('scatter'); });
  addPainter(drawing.element, ['brush', 'colour', 'scatter', 'size', 'theme', 'draw'], () => {
    const pen = penOf(drawing, 0), box = scatterBox(drawing);
    drawFrame(pen, box);
    drawScatterWords(pen, box);
    drawScatterBrush(pen, box);
    drawScatterPoints(pen, box);
    if (columns[scatter.x].points || columns[scatter.y].points) drawScatterWhiskers(pen, box);
  });
  addPainter(drawing.element, ['run', 'hover', 'scatter', 'size', 'theme'], () => drawScatterLit(drawing));
  const nearest = ({x, y}) => nearestDrawn(at => {
    const point = scatterPoint(scatterBox(drawing), at);
    return point ? Math.hypot(point[0] - x, point[1] - y) : Infinity;
  }, 14);
  listenToPointer(drawing.element, {
    move: place => hover(nearest(place), place.page.clientX, place.page.clientY),
    leave: () => hover(-1),
    start: () => hover(-1),
    drag: (place, origin) => {
      const box = scatterBox(drawing);
      const range = (a, b) => [Math.max(-0.05, Math.min(a, b)), Math.min(1.05, Math.max(a, b))];
      setBrush(scatter.x, range((origin.x - box.x) / box.width, (place.x - box.x) / box.width));
      setBrush(scatter.y, range(1 - (origin.y - box.y) / box.height, 1 - (place.y - box.y) / box.height));
    },
    tap: place => {
      const at = nearest(place);
      if (at >= 0) return goTo(at);
      setBrush(scatter.x, null);
      setBrush(scatter.y, null);
    },
  });
}

// ---- heat map ------------------------------------------------------------------------------------
const heat = {x: 0, y: 1, cells: []};
const mostCells = 16;  // along an axis; more values than that share cells

/** The cell of each stop along an axis, and the text of each cell. */
function cellsOf(axis) {
  const stops = axis.texts.length, count = Math.min(stops, mostCells);
  if (stops <= mostCells) return {count, of: axis.texts.map((_, k) => k), texts: axis.texts};
  // By place, so that a cell is as wide as the others on the axis's scale.
  const of = axis.places.map((place, k) => Math.min(count - 1, Math.floor(
    (axis.isChoice ? k / stops : clamp01(place)) * count)));
  const texts = Array.from({length: count}, (_, cell) => axis.texts[of.indexOf(cell)] ?? '');
  return {count, of, texts};
}

/**
 * Runs of each cell: all that are kept, or those at the sliders of the other axes. Means are those of
 * values, also where the scale is logarithmic; choices have no values and take their places.
 */
function gatherCells(across, up, isSlice) {
  const cells = Array.from({length: across.count * up.count},
                           () => ({runs: [], failed: 0, sum: 0, colour: 0, count: 0}));
  const column = columns[state.colour];
  for (const at of state.kept) {
    const x = axes[heat.x].stopOf[at], y = axes[heat.y].stopOf[at];
    if (x < 0 || y < 0) continue;
    const isThere = axes.every(
      (axis, k) => k === heat.x || k === heat.y || axis.isSeed || axis.stopOf[at] === state.stops[k]);
    if (isSlice && !isThere) continue;
    const cell = cells[up.of[y] * across.count + across.of[x]];
    cell.runs.push(at);
    if (rows[at].failed) ++cell.failed;
    else if (column && !isNaN(column.places[at])) {
      const {isChoice} = column.scale;
      cell.sum += isChoice ? column.places[at] : rows[at].cells[column.at];
      cell.colour += isChoice ? colourPlace(column, at) : colourValue(column, at);
      ++cell.count;
    }
  }
  return cells;
}

/** The mean of the runs of a cell, as text. */
function meanText({scale}, cell) {
  const mean = cell.sum / cell.count;
  return scale.isChoice ? scale.text(mean) : scale.show(mean);
}

const heatBox = drawing => ({x: 74, y: 8, width: drawing.width - 82, height: drawing.height - 52});

/** Stripes over a cell with failed runs: it is never taken for a good one. */
function drawStripes(pen, x, y, width, height, isAll) {
  pen.save();
  pen.beginPath();
  pen.rect(x, y, width, height);
  pen.clip();
  pen.strokeStyle = theme.bad;
  pen.lineWidth = isAll ? 2.5 : 1.2;
  pen.beginPath();
  for (let d = -height; d < width; d += 9) {
    pen.moveTo(x + d, y + height);
    pen.lineTo(x + d + height, y);
  }
  pen.stroke();
  pen.restore();
}

function drawHeatCell(pen, cell, x, y, width, height) {
  if (cell.runs.length === 0) return;
  const column = columns[state.colour], {scale} = column, mean = cell.colour / cell.count;
  const colour = isNaN(mean) || scale.isChoice ? mean : scale.at(mean);  // no number where the metric is noise
  pen.fillStyle = isNaN(colour) ? theme.faint : rampColour(colour);
  pen.fillRect(x, y, width, height);
  if (cell.failed > 0) drawStripes(pen, x, y, width, height, cell.count === 0);
  if (cell.count === 0 || width < 44 || height < 18) return;
  const ink = isNaN(colour) ? theme.ink : colour > 0.35 ? '#10161d' : '#fff';
  const s = cell.runs.every(at => pointOf(at) === pointOf(cell.runs[0])) && summaryOf(column, cell.runs[0]);
  const text = meanText(column, cell) + (s && !column.isNoise ? '  ' + s.letters : '');
  drawText(pen, text, x + width / 2, y + height / 2 + 4, width - 4, {align: 'center', colour: ink});
  if (!s || height < 34) return;
  // Its whisker, along the lower edge.
  const at = value => x + 6 + clamp01(scale.at(value)) * (width - 12), line = y + height - 9;
  pen.fillStyle = ink;
  pen.fillRect(at(s.min), line - 1, at(s.max) - at(s.min) + 1, 2);
  pen.fillRect(at(s.mean) - 3, line - 3, 6, 6);
}

function drawHeat(drawing) {
  const pen = penOf(drawing, 0), box = heatBox(drawing);
  const across = cellsOf(axes[heat.x]), up = cellsOf(axes[heat.y]);
  const width = box.width / across.count, height = box.height / up.count;
  heat.cells = gatherCells(across, up, by('heat-of').value === 'slice');
  pen.fillStyle = theme.card;
  pen.fillRect(box.x, box.y, box.width, box.height);
  heat.cells.forEach((cell, k) => {
    const x = k % across.count, y = Math.floor(k / across.count);
    drawHeatCell(pen, cell, box.x + x * width + 0.5, box.y + (up.count - 1 - y) * height + 0.5, width - 1,
                 height - 1);
  });
  // The cell at the sliders.
  pen.strokeStyle = theme.ink;
  pen.lineWidth = 2.5;
  pen.strokeRect(box.x + across.of[state.stops[heat.x]] * width + 1,
                 box.y + (up.count - 1 - up.of[state.stops[heat.y]]) * height + 1, width - 2, height - 2);
  const every = Math.ceil(46 / width);
  across.texts.forEach((text, k) => {
    if (k % every === 0)
      drawText(pen, text, box.x + (k + 0.5) * width, box.y + box.height + 14, every * width - 4,
               {align: 'center'});
  });
  up.texts.forEach((text, k) => drawText(
    pen, text, box.x - 5, box.y + (up.count - 0.5 - k) * height + 4, box.x - 6, {align: 'right'}));
  drawText(pen, axes[heat.x].name, box.x + box.width / 2, box.y + box.height + 34, box.width,
           {align: 'center', colour: theme.ink});
}

function heatCellAt(drawing, {x, y}) {
  const box = heatBox(drawing), across = cellsOf(axes[heat.x]), up = cellsOf(axes[heat.y]);
  const column = Math.floor((x - box.x) / box.width * across.count);
  const line = up.count - 1 - Math.floor((y - box.y) / box.height * up.count);
  if (column < 0 || column >= across.count || line < 0 || line >= up.count) return null;
  return heat.cells[line * across.count + column] || null;
}

function heatTip(cell) {
  const lines = [cell.runs.length === 1 ? rows[cell.runs[0]].name : cell.runs.length + ' runs'];
  if (cell.count > 0)
    lines.push(columns[state.colour].title + ' ' + meanText(columns[state.colour], cell));
  if (cell.runs.length <= seeds) lines.push(pointText(columns[state.colour], cell.runs[0]));
  if (cell.failed > 0) lines.push(cell.failed === 1 ? '1 failed' : cell.failed + ' failed');
  return lines.join('\n');
}

/** Arrow keys walk along the two axes of the map. */
function heatKey(event) {
  const step = {ArrowLeft: [heat.x, -1], ArrowRight: [heat.x, 1], ArrowDown: [heat.y, -1],
                ArrowUp: [heat.y, 1]}[event.key];
  if (!step) return;
  event.preventDefault();
  slideTo(step[0], state.stops[step[0]] + step[1]);
}

function startHeat() {
  const section = by('heat').closest('section');
  const options = axes.map((axis, k) => [k, axis.name]).filter(([k]) => k !== seedAxis);
  section.hidden = options.length < 2 || state.colour < 0;
  if (section.hidden) return;
  const drawing = watchCanvas(by('heat'));
  const pick = (own, other) => k => {
    // A map needs two different axes: swap them.
    if (heat[other] === k) heat[other] = heat[own];
    heat[own] = k;
    by('heat-x').value = heat.x;
    by('heat-y').value = heat.y;
    change('heat');
  };
  fillSelect(by('heat-x'), options, heat.x, pick('x', 'y'));
  fillSelect(by('heat-y'), options, heat.y, pick('y', 'x'));
  by('heat-of').closest('label').hidden = options.length < 3;
  by('heat-of').addEventListener('change', () => change('heat'));
  addPainter(drawing.element, ['brush', 'colour', 'run', 'heat', 'size', 'theme'], () => {
    drawHeat(drawing);
    by('heat-title').textContent = 'Heat map of ' + titleOf(columns[state.colour]);
    drawing.canvases[0].setAttribute('aria-label', `heat map of ${columns[state.colour].title} across ` +
      `${axes[heat.x].name} and ${axes[heat.y].name}; arrow keys move along them`);
  });
  drawing.element.addEventListener('keydown', heatKey);
  listenToPointer(drawing.element, {
    move: place => {
      const cell = heatCellAt(drawing, place);
      hover(cell && cell.runs.length === 1 ? cell.runs[0] : -1);
      if (cell && cell.runs.length > 0) placeTip(heatTip(cell), place.page.clientX, place.page.clientY);
    },
    leave: () => hover(-1),
    tap: place => {
      const cell = heatCellAt(drawing, place);
      if (!cell || cell.runs.length === 0) return;
      goTo(cell.runs.includes(state.run) ? state.run : nearestOf(cell.runs));
    },
  });
}

/** Of some runs, the one that needs the fewest of the other sliders to move. */
function nearestOf(runs) {
  const moves = at => axes.filter((axis, k) => axis.stopOf[at] !== state.stops[k]).length;
  return runs.reduce((best, at) => moves(at) < moves(best) ? at : best);
}
