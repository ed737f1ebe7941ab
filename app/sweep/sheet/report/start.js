// ---- start ---------------------------------------------------------------------------------------
/** report.html#run-12 shows run 12. */
function goToAddress() {
  const found = /^#run-(\d+)$/.exec(location.hash);
  const row = found && rows.find(r => r.run === Number(found[1]));
  if (!row) return false;
  goTo(row.at);
  return true;
}

/** The first run that is well, or the first. */
function firstRun() {
  return Math.max(0, rows.findIndex(row => row.state === 'ok' && isOnAxes(row.at)));
}

function start() {
  readTheme();
  startStage();
  startSliders();
  startDraws();
  startTime();
  startPeek();
  startFacts();
  startFilter();
  startStars();
  startColour();
  startTiles();
  startParallel();
  startScatter();
  startHeat();
  startTable();
  document.addEventListener('click', event => {
    const button = event.target.closest('button[data-copy]');
    if (button) copyFrom(button);
  });
  addEventListener('hashchange', () => {
    if (goToAddress()) by('walk').scrollIntoView();
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    readTheme();
    change('theme');
  });
  if (!goToAddress()) goTo(firstRun());
  filterRuns();
  paintAll();
  document.body.dataset.ready = 'yes';
}

if (rows.length > 0) start();
