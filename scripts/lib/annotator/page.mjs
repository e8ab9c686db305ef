// The page as somebody has it who annotates a clip: what he does, each step an action, and what he sees, which is none. All of it goes through
// the mouse and the keyboard.

import { performance } from 'node:perf_hooks';

/** Longest time of one step, milliseconds. */
const PATIENCE = 900_000;
/** Of a slider, pixels. */
const THUMB = 16;

/**
 * Opens the page with `settings` in its address, and returns `{ log, actions, seconds, open, segment, … }`. `log` has the name of every action; what
 * is seen in between can be added as objects. `seconds` is the time that actions took.
 */
export async function annotatedPage(page, address, settings) {
  page.setDefaultTimeout(PATIENCE);
  await page.goto(`${address}#sample=intel-two-cars&segment=asked&${settings}`);
  const log = [];
  let milliseconds = 0;
  const act = async (name, does) => {
    log.push(name);
    const began = performance.now();
    const result = await does();
    milliseconds += performance.now() - began;
    return result;
  };
  return {
    log,
    actions: () => log.filter((line) => typeof line === 'string').length,
    seconds: () => milliseconds / 1000,
    open: (files) => act('open', () => open(page, files)),
    segment: () => act('segment', () => changing(page, () => page.locator('#clip-segment').click())),
    goTo: (frame) => act(`frame ${frame}`, () => goTo(page, frame)),
    key: (key) => act(`key ${key.toUpperCase()}`, () => page.keyboard.press(key)),
    /** Sets the radius of the brush, about. */
    brush: (radius) => act('size', () => slide(page, radius)),
    stroke: (points) => act('stroke', () => changing(page, () => drag(page, points))),
    box: (from, to) => act('box', () => changing(page, () => drag(page, [from, to]))),
    /** The steps that make two objects one. */
    merging: (one, other) => {
      const row = page.locator(`#objects > [data-mask="${one}"]`);
      return [
        () => act(`object ${one}`, () => row.locator('.motion-head').click()),
        () => act('more', () => row.locator('summary').click()),
        () => act(`merge with ${other}`, () => row.locator('[data-action=merge-with]').selectOption(String(other))),
        () => act('merge', () => changing(page, () => row.locator('[data-action=merge]').click())),
      ];
    },
    acceptAll: () => act('accept all', () => page.locator('#accept-all').click()),
    /** Saves the clip in the format that is offered first, CVAT's tracks. Returns the path of the file. */
    save: async () => {
      await act('export', () => page.locator('#open-export').click());
      const waiting = page.waitForEvent('download');
      return act('save', async () => {
        await page.locator('#clip-export button').click();
        return (await waiting).path();
      });
    },
    /** The state on screen beside the picture: the frame, the tool, its radius, the selected object and all objects. */
    state: () => page.evaluate(stateOnScreen),
    /** The number of each pixel's mask in every frame, by its colour. The frame on screen stays. */
    look: async () => {
      const { frame, frames } = await page.evaluate(stateOnScreen);
      const labels = [];
      for (let index = 0; index < frames; index += 1) {
        await goTo(page, index);
        labels.push(new Uint8Array(Buffer.from(await page.evaluate(labelsOnScreen), 'base64')));
      }
      await goTo(page, frame);
      return labels;
    },
  };
}

async function open(page, files) {
  await page.locator('#open-pair').setInputFiles(files);
  await page.waitForFunction((count) => document.querySelector('#clip-name').textContent.includes(`${count} frames`), files.length);
  await reached(page, '#run', 'idle');
}

/** Does something, and waits until the masks of the clip have changed. */
async function changing(page, does) {
  const changed = page.evaluate(() => {
    const run = document.querySelector('#clip-run');
    return new Promise((resolve) => {
      const look = (records) =>
        records.some(({ oldValue }) => oldValue === 'working') && run.dataset.phase !== 'working' && resolve(run.dataset.phase);
      new MutationObserver(look).observe(run, { attributeFilter: ['data-phase'], attributeOldValue: true });
    });
  });
  await does();
  const phase = await changed;
  if (phase !== 'done') throw new Error(`The clip is '${phase}'.`);
}

async function reached(page, selector, phase) {
  await page.waitForFunction(([selector, phase]) => document.querySelector(selector).dataset.phase === phase, [selector, phase]);
}

/** Presses on the timeline, whose last frame is under the handle of the out point. */
async function goTo(page, frame) {
  const track = page.locator('#track');
  const [{ width }, last] = await Promise.all([track.boundingBox(), track.getAttribute('aria-valuemax')]);
  if (frame === Number(last)) await track.press('End');
  else await track.click({ position: { x: ((frame + 0.5) * width) / (Number(last) + 1), y: 10 } });
  await page.waitForFunction((frame) => document.querySelector('#caption').textContent === `Frame ${frame}`, frame);
  await reached(page, '#run', 'done');
}

/** Draws through points of the picture, [x, y] in pixels of the frame. */
async function drag(page, points) {
  const [box, size] = await Promise.all([
    page.locator('.layers').boundingBox(),
    page.locator('#frame').evaluate(({ width, height }) => ({ width, height })),
  ]);
  const places = points.map(([x, y]) => [box.x + ((x + 0.5) / size.width) * box.width, box.y + ((y + 0.5) / size.height) * box.height]);
  await page.mouse.move(...places[0]);
  await page.mouse.down();
  for (const place of places) await page.mouse.move(...place);
  await page.mouse.up();
}

/** Presses on the slider of the brush, which stands or lies. */
async function slide(page, radius) {
  const slider = page.locator('#tools [name=radius]');
  const [{ width, height }, { min, max }] = await Promise.all([
    slider.boundingBox(),
    slider.evaluate(({ min, max }) => ({ min: Number(min), max: Number(max) })),
  ]);
  const along = THUMB / 2 + ((radius - min) / (max - min)) * (Math.max(width, height) - THUMB);
  await slider.click({ position: height > width ? { x: width / 2, y: height - along } : { x: along, y: height / 2 } });
}

/** Runs in the page. */
function stateOnScreen() {
  const number = (selector, name) => Number(document.querySelector(selector).getAttribute(name));
  return {
    frame: number('#track', 'aria-valuenow'),
    frames: number('#track', 'aria-valuemax') + 1,
    tool: document.querySelector('#tools [name=tool]:checked').value,
    radius: Number(document.querySelector('#tools [name=radius]').value),
    selected: Number(document.querySelector('#objects > .selected')?.dataset.mask ?? 0),
    objects: [...document.querySelectorAll('#objects > li')].map(({ dataset }) => Number(dataset.mask)).filter((id) => id > 0),
  };
}

/** Runs in the page. Returns a byte for each pixel, as base64. */
function labelsOnScreen() {
  const fill = document.querySelector('#fill');
  const copy = new OffscreenCanvas(fill.width, fill.height).getContext('2d', { willReadFrequently: true });
  const wordOf = (colour) => {
    copy.fillStyle = colour;
    copy.fillRect(0, 0, 1, 1);
    return new Uint32Array(copy.getImageData(0, 0, 1, 1).data.buffer)[0];
  };
  const rows = [...document.querySelectorAll('#objects > li')];
  const numbers = new Map(rows.map((row) => [wordOf(row.style.getPropertyValue('--colour')), Number(row.dataset.mask)]));
  if (numbers.size < rows.length) throw new Error('Two objects have the same colour.');
  copy.clearRect(0, 0, 1, 1);
  copy.drawImage(fill, 0, 0);
  const words = new Uint32Array(copy.getImageData(0, 0, fill.width, fill.height).data.buffer);
  let binary = '';
  for (const word of words) binary += String.fromCharCode(word === 0 ? 0 : (numbers.get(word) ?? 255));
  return btoa(binary);
}
