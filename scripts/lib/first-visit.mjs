// How long a first visitor waits: the page is opened anew with nothing kept, until its clip is found.

/** How often it is opened. */
const VISITS = 3;

/** Medians over visits, milliseconds since the page was asked for: the module is there, masks are first drawn, the clip is found; and the longest task. */
export async function firstVisits(browser, address) {
  const visits = [];
  for (let k = 0; k < VISITS; k += 1) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
    const page = await context.newPage();
    await page.addInitScript(watch);
    await page.goto(address);
    await page.waitForFunction(() => document.querySelector('#clip-run').dataset.phase === 'done', undefined, { timeout: 0 });
    visits.push(await page.evaluate(told));
    await context.close();
  }
  return Object.fromEntries(Object.keys(visits[0]).map((name) => [name, median(visits.map((visit) => visit[name]))]));
}

/** Runs in the page before its own scripts: notes when there are masks first, and the tasks that block it. */
function watch() {
  const seen = (globalThis.seen = { masks: null, found: null, longest: 0 });
  new PerformanceObserver((list) => {
    for (const { duration } of list.getEntries()) seen.longest = Math.max(seen.longest, duration);
  }).observe({ type: 'longtask', buffered: true });
  const look = () => {
    const fill = document.querySelector('#fill');
    const isDrawn = seen.masks === null && document.querySelector('#run')?.dataset.phase === 'done' && fill.width > 0;
    if (
      isDrawn &&
      fill
        .getContext('2d')
        .getImageData(0, 0, fill.width, fill.height)
        .data.some((value) => value > 0)
    )
      seen.masks = performance.now();
    if (document.querySelector('#clip-run')?.dataset.phase === 'done') seen.found = performance.now();
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

function told() {
  const { masks, found, longest } = globalThis.seen;
  const module = performance.getEntriesByType('resource').find(({ name }) => name.endsWith('.wasm')).responseEnd;
  return { module, masks, found, longest };
}

function median(values) {
  return values.toSorted((one, other) => one - other)[Math.floor(values.length / 2)];
}

/** Runs in the page: from now on the tasks that block it are noted. */
export function watchTasks() {
  const tasks = (globalThis.longTasks = []);
  new PerformanceObserver((list) => tasks.push(...list.getEntries().map(({ duration }) => duration))).observe({ type: 'longtask' });
}

/** Runs in the page: how many tasks blocked it for more than 50 ms since the last call, and the longest, milliseconds. */
export function tasksSince() {
  const tasks = globalThis.longTasks.splice(0);
  return { count: tasks.length, longest: Math.max(0, ...tasks) };
}
