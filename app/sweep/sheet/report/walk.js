// ---- the walk: sliders, picture, comparison, facts -----------------------------------------------
/** Goes to a run; the sliders follow where it is on the axes. */
function goTo(at) {
  state.run = at;
  const draw = state.stops[seedAxis];
  axes.forEach((axis, k) => { if (axis.stopOf[at] >= 0) state.stops[k] = axis.stopOf[at]; });
  change('run', ...state.stops[seedAxis] !== draw ? ['draw'] : []);
}

/** Goes to a stop of one axis, and to the run that is nearest there. */
function slideTo(k, stop) {
  state.stops[k] = Math.max(0, Math.min(axes[k].texts.length - 1, stop));
  state.run = nearestRun(state.stops);
  change('run', ...axes[k].isSeed ? ['draw'] : []);
}

/** A button for each seed of the point that is shown, with how its snow ended; [ and ] go through them. */
function startDraws() {
  const box = by('draws');
  box.hidden = !hasSeeds;
  if (!hasSeeds) return;
  const flip = by => slideTo(seedAxis, (state.stops[seedAxis] + by + seeds) % seeds);
  const buttons = axes[seedAxis].texts.map((text, k) => {
    const button = make('button', {type: 'button', textContent: 'seed ' + text});
    button.addEventListener('click', () => slideTo(seedAxis, k));
    return button;
  });
  const words = make('span');
  box.append(...buttons, words);
  addEventListener('keydown', event => {
    if (event.target.closest('input:not([type="range"]), select') || event.ctrlKey || event.metaKey) return;
    if (event.key === '[') flip(-1);
    if (event.key === ']') flip(1);
  });
  addPainter(null, ['run', 'mode'], () => {
    const at = rows[state.mode === 'one' ? state.run : runAt('b')].at, first = at - drawOf(at);
    buttons.forEach((button, k) => {
      const {broken, failed} = rows[first + k];
      button.setAttribute('aria-pressed', String(drawOf(at) === k));
      button.textContent = 'seed ' + axes[seedAxis].texts[k] +
        (failed ? ' \u2715' : broken === null ? '' : broken ? ' breaks' : ' holds');
    });
    words.textContent = outcomeText(at);
    words.className = sweep.outcomes[pointOf(at)].undecided ? 'undecided' : '';
  });
}

function startSliders() {
  const sliders = axes.map((axis, k) => {
    const id = 'axis-' + k;
    const input = make('input', {type: 'range', id, min: 0, max: axis.texts.length - 1, step: 1});
    const output = make('output'), marker = make('i', {title: 'the run that is shown'});
    input.addEventListener('input', () => slideTo(k, Number(input.value)));
    const box = make('div', {className: 'slider'}, make('label', {htmlFor: id, textContent: axis.name,
      title: axis.name}), output, make('span', {className: 'track'}, input, marker));
    by('sliders').append(box);
    return {box, input, output, marker};
  });
  addPainter(null, ['run'], () => {
    sliders.forEach(({box, input, output, marker}, k) => {
      const axis = axes[k], stop = axis.stopOf[state.run], last = axis.texts.length - 1;
      input.value = state.stops[k];
      output.textContent = axis.texts[state.stops[k]];
      output.title = output.textContent;
      input.setAttribute('aria-valuetext', output.textContent);
      box.classList.toggle('off', stop < 0);
      marker.classList.toggle('same', stop === state.stops[k]);
      // The thumb's middle stays half a thumb inside of the track.
      marker.style.left = `calc(8px + (100% - 16px) * ${last > 0 ? stop / last : 0.5})`;
    });
    const text = nearestText();
    by('nearest').textContent = text;
    by('nearest').classList.toggle('far', text !== '');
  });
}

/** Says that the shown run is not where the sliders are, and in what it differs. */
function nearestText() {
  const row = rows[state.run];
  if (!isOnAxes(row.at)) return `Run ${row.run} is beside the axes: the sliders lead back to the others.`;
  const away = axes.map((axis, k) => [axis, k]).filter(([axis, k]) => axis.stopOf[row.at] !== state.stops[k]);
  if (away.length === 0) return '';
  const parts = away.slice(0, 3).map(
    ([axis, k]) =>
      `${axis.name}: ${axis.texts[axis.stopOf[row.at]]} instead of ${axis.texts[state.stops[k]]}`);
  if (away.length > 3) parts.push(`${away.length - 3} more axes`);
  return `There is no run here; the nearest is run ${row.run}, with ${parts.join('; ')}.`;
}

// ---- time ----------------------------------------------------------------------------------------
let playTimer = 0;

function showFrame(index) {
  state.frame = frames[Math.max(0, Math.min(frames.length - 1, index))];
  change('frame');
}

/** Shows the next picture as soon as the last one is loaded. */
function playOn() {
  const isWaiting = [...document.querySelectorAll('#plates img[src]')].some(image => !image.complete);
  if (!isWaiting) showFrame((frames.indexOf(state.frame) + 1) % frames.length);
}

function setPlaying(isOn) {
  clearInterval(playTimer);
  playTimer = isOn ? setInterval(playOn, Math.max(33, 1000 / (sweep.fps || 24))) : 0;
  by('play').textContent = isOn ? '\u275a\u275a' : '\u25b6';
  by('play').setAttribute('aria-label', isOn ? 'pause' : 'play');
  by('play').setAttribute('aria-pressed', String(isOn));
}

/** The frame, and its time where it is the same in all runs that are shown. */
function momentText(frame) {
  const shown = state.mode === 'one' ? [state.run] : [runAt('a'), runAt('b')];
  const [fps, ...others] = new Set(shown.map(at => rows[at].fps ?? sweep.fps));
  return 'frame ' + frame +
    (fps > 0 && others.length === 0 ? `, ${((frame - sweep.firstNumber) / fps).toFixed(3)} s` : '');
}

function startTime() {
  const moment = by('moment');
  moment.max = frames.length - 1;
  by('time').hidden = frames.length < 2;
  moment.addEventListener('input', () => { setPlaying(false); showFrame(Number(moment.value)); });
  by('play').addEventListener('click', () => setPlaying(playTimer === 0));
  addPainter(null, ['frame', 'run', 'mode'], () => {
    moment.value = frames.indexOf(state.frame);
    by('moment-text').textContent = momentText(state.frame);
    moment.setAttribute('aria-valuetext', momentText(state.frame));
  });
}

// ---- the picture, two of them, their difference --------------------------------------------------
/** The run at a plate: pinned, or the one at the sliders. */
const runAt = plate => state.pins[plate] >= 0 ? state.pins[plate] : state.mode === 'one' || plate === 'b'
  ? state.run : state.pins.a;

function captionOf(row) {
  if (row.frames.length === 0) return `${row.name}: ${row.state}, no picture`;
  const last = row.frames[row.frames.length - 1];
  const until = isLate(row, state.frame) && row.state !== 'ok' ? ` at frame ${last}` : '';
  return row.name + (row.state === 'ok' ? '' : `: ${row.state}${until}`);
}

function fillPlate(plate, at, letter) {
  const row = rows[at], image = plate.querySelector('img'), address = pictureOf(row, state.frame);
  image.classList.toggle('none', address === '');
  if (address === '') image.removeAttribute('src');
  else if (image.getAttribute('src') !== address) image.src = address;
  image.alt = captionOf(row);
  plate.classList.toggle('failed', row.failed);
  plate.classList.toggle('late', isLate(row, state.frame));
  const caption = plate.querySelector('figcaption'), text = captionOf(row);
  caption.textContent = image.dataset.lost === address && address !== ''
    ? `${text}: no picture at ${address}; keep report.html beside its folder runs` : letter + text;
}

function compareText() {
  if (state.mode === 'one') return '';
  const name = at => rows[at].name, a = name(runAt('a')), b = name(runAt('b'));
  const follows = state.pins.b < 0 ? ', which follows the sliders' : '';
  const start = state.mode === 'side' ? '' : 'Black where A and B are the same. ';
  return `${start}A: ${a}. B: ${b}${follows}.${differenceText(runAt('a'), runAt('b'))}`;
}

function pin(plate) {
  state.pins[plate] = state.pins[plate] >= 0 ? -1 : state.run;
  if (plate === 'a' && state.pins.a < 0) state.mode = 'one';
  else if (state.mode === 'one') state.mode = 'side';
  if (state.mode !== 'one' && state.pins.a < 0) state.pins.a = state.run;
  change('mode');
}

function setMode(mode) {
  state.mode = mode;
  if (mode !== 'one' && state.pins.a < 0) state.pins.a = state.run;
  change('mode');
}

function startStage() {
  const plates = by('plates'), plate = name => plates.querySelector(`[data-plate="${name}"]`);
  const [width, height] = sweep.tile;
  plates.style.setProperty('--shape', `${width} / ${height}`);
  plates.style.setProperty('--ratio', String(width / height));
  for (const image of plates.querySelectorAll('img')) {
    image.addEventListener('error', () => {
      image.dataset.lost = image.getAttribute('src');
      change('frame');
    });
  }
  document.querySelectorAll('[name="mode"]').forEach(
    radio => radio.addEventListener('change', () => setMode(radio.value)));
  document.querySelectorAll('[data-pin]').forEach(
    button => button.addEventListener('click', () => pin(button.dataset.pin)));
  const gain = by('gain');
  gain.addEventListener('input', () => change('mode'));
  addPainter(null, ['run', 'frame', 'mode'], () => {
    plates.dataset.mode = by('walk').dataset.mode = state.mode;
    plates.style.setProperty('--gain', String(2 ** gain.value));
    by('gain-text').textContent = '\u00d7' + 2 ** gain.value;
    by('gain-label').hidden = state.mode !== 'difference';
    document.querySelector(`[name="mode"][value="${state.mode}"]`).checked = true;
    for (const name of ['a', 'b']) {
      const isPinned = state.pins[name] >= 0, button = document.querySelector(`[data-pin="${name}"]`);
      button.setAttribute('aria-pressed', String(isPinned));
      button.textContent = isPinned ? `${name.toUpperCase()}: run ${rows[state.pins[name]].run} \u2715`
                                    : `pin as ${name.toUpperCase()}`;
    }
    if (state.mode !== 'one') fillPlate(plate('a'), runAt('a'), 'A: ');
    fillPlate(plate('b'), state.mode === 'one' ? state.run : runAt('b'), state.mode === 'one' ? '' : 'B: ');
    by('compare-text').textContent = compareText();
  });
}

// ---- the run in a corner, while its large picture is out of sight -----------------------------------
function startPeek() {
  const peek = by('peek'), image = peek.querySelector('img');
  peek.style.setProperty('--shape', by('plates').style.getPropertyValue('--shape'));
  new IntersectionObserver(entries => {
    peek.hidden = entries[entries.length - 1].isIntersecting;
    change('peek');
  }).observe(by('plates'));
  peek.addEventListener('click', () => by('walk').scrollIntoView());
  addPainter(null, ['run', 'hover', 'frame', 'peek'], () => {
    if (peek.hidden) return;
    const row = rows[state.hover >= 0 ? state.hover : state.run], address = pictureOf(row, state.frame);
    if (address === '') image.removeAttribute('src');
    else if (image.getAttribute('src') !== address) image.src = address;
    peek.querySelector('span').textContent = '\u25b2 ' + captionOf(row);
    peek.classList.toggle('failed', row.failed);
  });
}

// ---- facts of the run ----------------------------------------------------------------------------
function linkRow(label, command) {
  return make('div', {}, make('span', {textContent: label}),
              make('code', {textContent: command, title: command}),
              copyButton(command, 'copy the command: ' + label));
}

function noteOf(row) {
  return [row.state === 'ok' ? '' : row.state + (row.reason ? ': ' + row.reason : ''),
          row.why ? outcomeText(row.at) + (row.full ? '' : ' (' + row.why + ')') : '', ...row.warnings]
    .filter(text => text).join('\n');
}

/** Of a metric with seeds also its range over them. */
function factText(column, row) {
  const text = cellText(row, column.at), s = summaryOf(column, row.at);
  return !s || s.min === s.max ? text : `${text} (${roughText(s.min)} to ${roughText(s.max)})`;
}

function factRows() {
  const told = columns.filter(column => ['parameter', 'metric'].includes(column.kind) && column.scale);
  return told.map(column => {
    const a = make('td', {className: 'a'}), b = make('td');
    const head = make('th', {scope: 'row', textContent: column.title,
      title: column.isNoise ? noiseWords : column.help});
    const line = make('tr', {}, head, a, b);
    by('facts').tBodies[0].append(line);
    return {column, a, b, line};
  });
}

function startFacts() {
  const facts = factRows();
  addPainter(null, ['run', 'mode'], () => {
    const row = rows[state.mode === 'one' ? state.run : runAt('b')];
    const other = rows[state.mode === 'one' ? state.run : runAt('a')];
    by('facts').classList.toggle('one', state.mode === 'one');
    for (const {column, a, b, line} of facts) {
      a.textContent = factText(column, other);
      b.textContent = factText(column, row);
      const isOther = a.textContent !== b.textContent && !isClose(column, other.at, row.at);
      line.className = (column.kind === 'parameter' ? 'parameter' : '') + (isOther ? ' other' : '') +
        (column.isNoise ? ' noise' : '');
    }
    by('shown-mark').replaceChildren(markOf(row));
    by('shown-title').textContent = (state.mode === 'one' ? '' : 'B: ') + row.name;
    by('shown-note').textContent = noteOf(row);
    by('shown-note').className = row.failed ? 'failed' : '';
  });
  addPainter(null, ['run', 'mode', 'frame'], () => {
    const row = rows[state.mode === 'one' ? state.run : runAt('b')], frame = frameOf(row, state.frame);
    const links = [linkRow('again', row.again)];
    if (row.promote) links.push(linkRow('as a shot', row.promote));
    if (frame !== undefined) {
      links.unshift(linkRow('this frame', row.viewFrame.replace('FRAME.png', pictureName(frame))));
      links.push(make('a', {href: pictureOf(row, state.frame), textContent: 'picture of frame ' + frame,
                            target: '_blank'}));
    }
    // The scene file of a branch is that of its beginning.
    if (row.view) links.unshift(linkRow('this run', row.view));
    by('shown-links').replaceChildren(...links);
  });
}
