// ---- stars and notes -----------------------------------------------------------------------------
/**
 * Those of the folder are in the page. A page from a file cannot write there: what is given here is
 * kept by the browser, and the command or the file that bring it to the folder are offered.
 */
const starColumn = columns.findIndex(column => column.kind === 'star');
const starKey = 'neve ' + sweep.star + ' by settings';
const noMark = {star: false, note: ''};
const isSame = (a, b) => a.star === b.star && a.note === b.note;

/** A run's place in what the browser keeps: its number is another once the sweep has other runs. */
const settingsKey = row => JSON.stringify(row.settings);

function startMarks() {
  const saved = JSON.parse(by('stars').textContent).runs;
  let given = {};
  try {
    given = JSON.parse(localStorage.getItem(starKey)) || {};
  } catch { /* a browser that keeps nothing */ }
  for (const row of rows) {
    const found = saved.find(mark => mark.run === row.run &&
      JSON.stringify(mark.settings) === settingsKey(row));
    row.savedMark = found ? {star: found.star, note: found.note} : noMark;
    const own = given[settingsKey(row)];
    row.mark = own && typeof own.note === 'string' ? {star: Boolean(own.star), note: own.note} : row.savedMark;
    showMark(row);
  }
}

/** In the table. */
function showMark(row) {
  const {star, note} = row.mark;
  row.cells[starColumn] = star || note ? (star ? '\u2605 ' : '') + note : null;
}

const unsavedRows = () => rows.filter(row => !isSame(row.mark, row.savedMark));

function setMark(row, mark) {
  row.mark = {...row.mark, ...mark};
  showMark(row);
  try {
    localStorage.setItem(starKey, JSON.stringify(Object.fromEntries(
      unsavedRows().map(other => [settingsKey(other), other.mark]))));
  } catch { /* it is in the page as long as that is open */ }
  change('star');
}

/** A star takes its note along, as `--remove` does in the folder. */
const toggleStar = row => setMark(row, row.mark.star ? noMark : {star: true});

/** On a tile. */
function starOf(row) {
  const star = make('i', {className: 'star'});
  showStar(star, row);
  return star;
}

function showStar(star, row) {
  star.textContent = row.mark.star ? '\u2605' : '\u2606';
  star.classList.toggle('on', row.mark.star);
  star.title = (row.mark.star ? 'take the star away' : 'give a star') + (row.mark.note ? ': ' + row.mark.note : '');
}

const shellWord = text => /^[\w.,/-]+$/.test(text) ? text : "'" + text.replaceAll("'", "'\\''") + "'";

/** The commands that bring the stars of this browser to the folder: runs with one note go together. */
function starCommands() {
  const groups = new Map();
  for (const row of unsavedRows()) {
    const {star, note} = row.mark, isNoteChanged = note !== row.savedMark.note;
    const end = !star ? ' --remove' : isNoteChanged ? ' --note ' + shellWord(note) : '';
    groups.set(end, [...groups.get(end) || [], row.run]);
  }
  return [...groups].map(([end, runs]) => `${sweep.star} ${runs.join(',')}${end}`).join(' && ');
}

/** With those that were taken away here: the folder still has them. */
function downloadStars() {
  const isGiven = mark => mark.star || mark.note;
  const runs = rows.filter(row => isGiven(row.mark) || isGiven(row.savedMark))
    .map(row => ({run: row.run, ...row.mark, key: row.key, settings: row.settings}));
  const text = JSON.stringify({format: 'neve stars 1', runs}, null, 2) + '\n';
  const link = make('a', {download: 'stars.json',
    href: URL.createObjectURL(new Blob([text], {type: 'application/json'}))});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function startStars() {
  const button = by('star'), note = by('star-note'), only = by('only-stars'), unsaved = by('unsaved');
  const shown = () => rows[state.mode === 'one' ? state.run : runAt('b')];
  button.addEventListener('click', () => toggleStar(shown()));
  note.addEventListener('change', () => {
    const text = note.value.trim();
    setMark(shown(), {note: text, star: shown().mark.star || text !== ''});
  });
  only.firstElementChild.addEventListener('change', event => {
    state.onlyStars = event.target.checked;
    change('brush');
  });
  addPainter(null, ['run', 'mode', 'star'], () => {
    const {mark} = shown();
    button.textContent = mark.star ? '\u2605 starred' : '\u2606 star';
    button.setAttribute('aria-pressed', String(mark.star));
    if (document.activeElement !== note) note.value = mark.note;
  });
  addPainter(null, ['star'], () => {
    const count = rows.filter(row => row.mark.star).length, open = unsavedRows();
    only.hidden = count === 0 && !state.onlyStars;
    unsaved.hidden = open.length === 0;
    if (unsaved.hidden) return;
    const command = starCommands();
    unsaved.replaceChildren(
      `${open.length === 1 ? 'The mark of run' : 'Marks of runs'} ${open.map(row => row.run).join(', ')} ` +
      `${open.length === 1 ? 'is' : 'are'} in this browser alone. In the folder with `,
      make('code', {textContent: command, title: command}), ' ', copyButton(command, 'copy the command'),
      ' or ', make('button', {type: 'button', textContent: 'stars.json', onclick: downloadStars,
                              title: 'download it, for ' + sweep.star + ' --read stars.json'}));
  });
}

startMarks();
