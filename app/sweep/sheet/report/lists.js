// ---- sheet and table: only what is in sight has elements ------------------------------------------
/** Rows of a list that are in sight of its box, and some around them. */
function sightOf(box, height, count, room) {
  const first = Math.max(0, Math.floor(box.top / height) - room);
  const last = Math.min(count, Math.ceil((box.top + box.height) / height) + room);
  return [first, last];
}

/**
 * The size of an element and how far it is scrolled, without asking the layout every time.
 * @param room that its padding takes
 */
function watchBox(element, room = 0) {
  const box = {width: 0, height: 0, top: 0};
  const measure = () => {
    // Its height as style.css limits it.
    const width = element.clientWidth - room, height = Math.round(0.7 * innerHeight);
    if (box.width === width && box.height === height) return;
    Object.assign(box, {width, height});
    change('size');
  };
  measure();
  new ResizeObserver(measure).observe(element);
  addEventListener('resize', measure);
  element.addEventListener('scroll', () => {
    box.top = element.scrollTop;
    change('scroll');
  }, {passive: true});
  return box;
}

// ---- sheet ---------------------------------------------------------------------------------------
/** A run's own values on the axes, or its label. */
function tileText(row) {
  if (row.label) return row.label;
  return axes.filter(axis => !axis.isSeed).slice(0, 3).map((axis, k) => axis.stopOf[row.at] >= 0 && axis.name !== 'run'
    ? axis.name + ' ' + axis.texts[axis.stopOf[row.at]] : '').filter(text => text).join(', ');
}

/** Pictures are loaded when their tile comes into sight. */
const tileSight = new IntersectionObserver(entries => {
  for (const {target, isIntersecting} of entries) {
    target.dataset.seen = isIntersecting ? 'yes' : '';
    if (isIntersecting) loadTile(target);
  }
});

function loadTile(tile) {
  const image = tile.querySelector('img'), address = pictureOf(rows[tile.dataset.at], state.frame);
  if (address === '' || image.getAttribute('src') === address) return;
  image.src = address;
}

function makeTile(row) {
  const text = tileText(row), note = row.state === 'ok' ? '' : row.state + (text ? '; ' : '');
  const tile = make('button', {type: 'button', className: 'tile ' + kindOf(row), title: noteOf(row)},
    make('img', {alt: '', decoding: 'async'}),
    starOf(row),
    ...row.full ? [make('span', {className: 'full', textContent: 'full resolution'})] : [],
    make('span', {}, markOf(row), make('b', {textContent: `${row.run}: ${note}${text}`})));
  tile.dataset.at = row.at;
  tile.dataset.run = row.run;
  tile.setAttribute('aria-label', `${row.name}, ${row.state}, ${text}`);
  if (hasSeals) sealTile(tile, row);
  return tile;
}

/** How often the snow of a point breaks, and the noise of the metric that gives the colours. */
function sealTile(tile, row) {
  const column = columns[state.colour], outcome = outcomeText(row.at);
  const seal = make('span', {className: 'seal'}, make('em', {textContent: outcome,
    className: sweep.outcomes[pointOf(row.at)].undecided ? 'undecided' : ''}));
  const s = column && summaryOf(column, row.at), twins = column && twinsOf(column);
  if (twins) {
    for (const [label, own] of [['coarse', twins.coarse], [row.full ? 'full' : 'expected', twins.full]]) {
      const summary = summaryOf(own, row.at);
      if (!summary) continue;
      seal.append(make('span', {className: own === twins.coarse ? 'coarse' : ''},
        make('small', {textContent: label}), whiskerOf(own, row.at, twins.place), ...lettersOf(own, summary)));
    }
  } else if (s) {
    seal.append(make('span', {}, whiskerOf(column, row.at), ...lettersOf(column, s)));
  }
  tile.classList.add('sealed');
  tile.append(seal);
  tile.setAttribute('aria-label', `${tile.getAttribute('aria-label')}, ${outcome}` +
    (s ? `, ${column.title} ${pointText(column, row.at)}` : ''));
}

/** Explains the marks on the tiles. */
function sealHint() {
  const column = columns[state.colour];
  if (!column || !column.points) return '';
  const twins = twinsOf(column);
  const start = twins
    ? `Whiskers: ${twins.coarse.title}, blue: the coarse runs over ${seeds} seeds, from min to max, with the mean; white: the ` +
      'runs at full resolution, or what is expected there with the interval that holds four times in five. '
    : isPredicted(column)
    ? `Whisker: ${column.title}, expected at full resolution, with the interval that holds four times in five. `
    : `Whisker: ${column.title} over ${seeds} seeds, from min to max, with the mean. `;
  return start + (column.isNoise ? 'It is noise here: all tiles are too close to call.'
    : column.isUnknown ? `Which tiles differ is not known: ${unknownWords}.`
    : `Tiles that share a letter${twins ? ' in the same line' : ''} are too close to call; they share a colour where they share a rank.`);
}

function tileLayout(width) {
  const across = sweep.across, least = width < 600 ? 140 : 180, most = Math.max(1, Math.floor(width / least));
  const fits = across > 1 && across <= most + 2 && width / across >= 120;
  const count = fits ? across : Math.min(most, Math.max(rows.length / seeds, 2));
  const side = Math.min(320, Math.floor(width / count));
  return {count, side, height: Math.round(side * sweep.tile[1] / sweep.tile[0]) + (hasSeals ? (hasTwins ? 100 : 82) : 40)};
}

function startTiles() {
  const element = by('tiles'), room = by('tiles-room'), box = watchBox(element, 12), tiles = new Map();
  const paint = parts => {
    if (hasSeals && parts.has('colour')) {
      for (const tile of tiles.values()) tile.remove();
      tiles.clear();
      element.classList.toggle('twins', hasTwins);
      by('seal-hint').textContent = sealHint();
    }
    const {count, side, height} = tileLayout(box.width);
    const lines = Math.ceil(state.shown.length / count);
    room.style.height = lines * height + 'px';
    // As high as for all runs: nothing below it may move while somebody drags there.
    element.style.height = Math.min(box.height, Math.ceil(rows.length / seeds / count) * height + 12) + 'px';
    const [first, last] = sightOf(box, height, lines, 1);
    const wanted = new Set();
    let before = null;
    state.shown.slice(first * count, last * count).forEach((at, k) => {
      wanted.add(at);
      if (!tiles.has(at)) tiles.set(at, makeTile(rows[at]));
      const tile = tiles.get(at), place = first * count + k;
      tile.style.cssText = `width:${side - 6}px;height:${height - 6}px;` +
        `transform:translate(${place % count * side}px,${Math.floor(place / count) * height}px)`;
      if (!tile.isConnected) tileSight.observe(tile);
      // In the order in which they are seen, for the Tab key.
      if (before ? before.nextSibling !== tile : room.firstChild !== tile)
        if (before) before.after(tile);
        else room.prepend(tile);
      before = tile;
    });
    for (const [at, tile] of tiles) {
      if (wanted.has(at)) continue;
      tileSight.unobserve(tile);
      tile.remove();
      tiles.delete(at);
    }
    markTiles();
  };
  const markTiles = () => tiles.forEach((tile, at) => {
    showStar(tile.querySelector('.star'), rows[at]);
    tile.classList.toggle('here', at === state.run);
    tile.classList.toggle('lit', at === state.hover);
  });
  addPainter(element, ['brush', 'sort', 'star', 'size', 'scroll', ...hasSeals ? ['draw', 'colour'] : []], paint);
  addPainter(element, ['run', 'hover'], markTiles);
  // A moment is drawn in the sheet when the slider rests: twenty pictures take longer than one.
  let rest = 0;
  addPainter(null, ['frame'], () => {
    clearTimeout(rest);
    rest = setTimeout(() => tiles.forEach(tile => { if (tile.dataset.seen) loadTile(tile); }), 150);
  });
  room.addEventListener('click', event => {
    const tile = event.target.closest('.tile');
    if (tile && event.target.closest('.star')) return toggleStar(rows[tile.dataset.at]);
    if (tile) goTo(Number(tile.dataset.at));
  });
  listenForRuns(room, '.tile');
}

/** Hovering and focus light a run everywhere. */
function listenForRuns(element, selector) {
  const atOf = event => {
    const found = event.target.closest && event.target.closest(selector);
    return found ? Number(found.dataset.at) : -1;
  };
  element.addEventListener('pointerover', event => hover(atOf(event)));
  element.addEventListener('pointerleave', () => hover(-1));
}

// ---- table ---------------------------------------------------------------------------------------
const rowHeight = 30;

/** Width of a column in letters, from all its texts: rows that come into sight change nothing. */
function columnLetters(column) {
  let most = 5;
  const extra = column.kind === 'state' ? 4 : 1;  // the mark
  for (const row of rows)
    most = Math.max(most, (pointText(column, row.at) || cellText(row, column.at)).length + extra);
  const word = Math.max(...column.title.split(/[ _]/).map(part => part.length)) + 2;
  return Math.min(Math.max(most, word), column.kind === 'reason' ? 48 : 26);
}

function makeTableHead(table) {
  const head = make('tr');
  const widths = columns.map(column => columnLetters(column) * 7.6 + 16);
  const group = make('colgroup', {}, ...widths.map(width => {
    const col = make('col');
    col.style.width = width + 'px';
    return col;
  }), make('col'));
  group.lastChild.style.width = '150px';
  columns.forEach((column, c) => {
    // Long names break behind an underscore.
    const title = column.title.replaceAll('_', '_\u200b');
    const button = make('button', {type: 'button', textContent: title + (column.isNoise ? ': noise' : ''),
      title: column.isNoise ? noiseWords : column.help});
    button.addEventListener('click', () => {
      state.sort = {column: c, way: state.sort.column === c ? -state.sort.way : 1};
      change('sort');
    });
    const cell = make('th', {scope: 'col',
      className: (column.text ? 'text' : '') + (column.isNoise ? ' noise' : '')}, button);
    head.append(cell);
  });
  head.append(make('th', {scope: 'col'}, make('button', {type: 'button', textContent: 'neve view',
                                                         disabled: true})));
  table.append(group, make('thead', {}, head));
  table.style.width = widths.reduce((sum, width) => sum + width, 150) + 'px';
  return [...head.children];
}

function makeTableRow(row) {
  const line = make('tr', {id: 'run-' + row.run, className: kindOf(row)});
  line.dataset.at = row.at;
  line.dataset.run = row.run;
  columns.forEach((column, c) => {
    const cell = make('td', {className: column.text ? 'text' : '', textContent: pointText(column, row.at) || cellText(row, c)});
    cell.classList.toggle('noise', Boolean(column.isNoise));
    if (column.kind === 'state') cell.prepend(markOf(row));
    if (column.kind === 'prediction') cell.title = row.why;
    if (column.kind === 'reason') cell.title = cell.textContent;
    if (column.kind === 'warnings' && row.warnings.length > 0) {
      cell.title = row.warnings.join('\n');
      cell.classList.add('warned');
    }
    line.append(cell);
  });
  const picture = pictureOf(row, frames[frames.length - 1]);
  const last = make('td', {}, copyButton(row.view, `copy the command that opens run ${row.run}`));
  if (picture !== '') last.append(' ', make('a', {href: picture, textContent: 'picture', target: '_blank'}));
  line.append(last);
  return line;
}

function startTable() {
  const element = by('table-box'), table = by('table'), heads = makeTableHead(table), lines = new Map();
  if (hasSeeds) {
    by('table-title').textContent = 'Points';
    by('table-hint').textContent = `A metric has its mean over ${seeds} seeds, from min to max, and its letters: ` +
      'points that share one are too close to call, and sorting by ranks keeps their order.';
  }
  if (sweep.predicts)
    by('table-hint').textContent += ' Columns called full have what coarse copies forecast for full resolution, with intervals that hold ' +
      `four times in five, or what the ${hasSeeds ? 'seeds there gave, from min to max' : 'run there gave, with how far another seed may lie'}; those that share a letter ` +
      'are too close to call.';
  const body = make('tbody'), box = watchBox(element);
  const above = make('tr', {className: 'room'}, make('td', {colSpan: columns.length + 1}));
  const below = above.cloneNode(true);
  body.append(above, below);
  table.append(body);
  const mark = () => lines.forEach((line, at) => {
    line.classList.toggle('here', at === state.run);
    line.classList.toggle('lit', at === state.hover);
  });
  addPainter(element, ['brush', 'sort', 'star', 'size', 'scroll', 'draw'], parts => {
    if (parts.has('star')) {
      for (const line of lines.values()) line.remove();
      lines.clear();
    }
    if (parts.has('sort')) heads.forEach((head, c) => c !== state.sort.column
      ? head.removeAttribute('aria-sort')
      : head.setAttribute('aria-sort', state.sort.way > 0 ? 'ascending' : 'descending'));
    element.style.minHeight = Math.min(box.height, rows.length / seeds * rowHeight + 80) + 'px';
    const [first, last] = sightOf(box, rowHeight, state.shown.length, 4);
    above.firstChild.style.height = first * rowHeight + 'px';
    below.firstChild.style.height = (state.shown.length - last) * rowHeight + 'px';
    const wanted = state.shown.slice(first, last), isWanted = new Set(wanted);
    for (const [at, line] of lines) {
      if (isWanted.has(at)) continue;
      line.remove();
      lines.delete(at);
    }
    let before = above;
    for (const at of wanted) {
      if (!lines.has(at)) lines.set(at, makeTableRow(rows[at]));
      const line = lines.get(at);
      if (before.nextSibling !== line) before.after(line);
      before = line;
    }
    mark();
  });
  addPainter(element, ['run', 'hover'], mark);
  body.addEventListener('click', event => {
    const line = event.target.closest('tr[data-at]');
    if (line && !event.target.closest('a, button')) goTo(Number(line.dataset.at));
  });
  listenForRuns(body, 'tr[data-at]');
}
