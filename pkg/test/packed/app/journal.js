// A clip in a worker with a journal in the page's storage: strokes, one after another, until all are there or the page is closed.

import { SegmenterPool } from './node_modules/veronese/dist/web.js';

const [WIDTH, HEIGHT, COUNT, STROKES] = [96, 64, 6, 8];

/** A textured square that moves over a textured background. */
function frame(k) {
  const level = (x, y, phase) => 128 + 50 * (Math.sin(0.55 * x + phase) * Math.cos(0.37 * y - phase) + 0.6 * Math.sin(0.21 * x + 0.43 * y));
  const data = new Uint8ClampedArray(4 * WIDTH * HEIGHT);
  for (let p = 0; p < WIDTH * HEIGHT; p++) {
    const [x, y] = [p % WIDTH, Math.floor(p / WIDTH)];
    const isIn = x >= 30 + k && x < 60 + k && y >= 20 && y < 50;
    const value = isIn ? level(x - k, y, 2) : level(x, y, 0);
    data.set([value, value, value, 255], 4 * p);
  }
  return { data, width: WIDTH, height: HEIGHT };
}

const strokesOf = (k) => Uint8Array.from({ length: WIDTH * HEIGHT }, (_, p) => (p % WIDTH >= 8 * k && p % WIDTH < 8 * k + 6 && p < 8 * WIDTH ? 1 : 255));

async function labelsOf(clip) {
  const labels = [];
  for (let k = 0; k < COUNT; k++) labels.push(String((await clip.labels(k)).labels));
  return labels.join();
}

async function main() {
  const pool = new SegmenterPool({ jobs: 2 });
  const journal = new URLSearchParams(location.search).get('journal') ?? undefined;
  const clip = await pool.openClip(Array.from({ length: COUNT }, (_, k) => frame(k)), { journal });
  globalThis.begun = clip.steps.undo;
  globalThis.settled = clip.steps.undo;
  if (!clip.frames[0].hasMasks) await clip.segment({ quality: 'fast' });
  globalThis.settled = clip.steps.undo;
  const second = await pool.openClip([frame(0), frame(1)], { journal }).then(() => 'opened', ({ message }) => message);
  for (let k = clip.steps.undo - 1; k < STROKES; k++) {
    await clip.annotate({ frame: k % COUNT, object: 2 + k, strokes: strokesOf(k) });
    globalThis.settled = clip.steps.undo;
  }
  return { labels: await labelsOf(clip), second, damaged: clip.isDamaged };
}

main().then((outcome) => (globalThis.outcome = outcome), (error) => (globalThis.outcome = { error: `${error.code}: ${error.message}` }));
