// The tables of docs/performance.md.

import { amount, fixed, origin, ratio, score, size, table } from './table.mjs';

const QUALITIES = ['fast', 'best'];
const TITLES = {
  fast: '`segmentPair`, fast',
  best: '`segmentPair`, best',
  farneback: 'OpenCV.js, Farneback’s flow alone',
  opencvPipeline: 'OpenCV.js, flow to labels',
  jsfeat: 'jsfeat, corners tracked',
  clip: '`segmentClip`, fast, `lookAhead: 0`, a frame',
  clipFlow: 'OpenCV.js, Farneback’s flow alone, a frame of the clip',
};
const CALLS = {
  'points 2': '`fitMotions`, n = 2, 600 measurements, 5 % noise',
  'points 3': '`fitMotions`, n = 3',
  'points 4': '`fitMotions`, n = 4',
  'pair fast': '`segmentPair`, 320 × 240, fast',
  'pair best': '`segmentPair`, 320 × 240, best',
};
/** Rows of memory while the long clip is segmented. */
const ROWS = 6;

export const PARTS = {
  browser: ['browser', (report) => [`${origin(report)} ${report.rounds} calls of each kind.`, downloads(report), calls(report)].join('\n\n')],
  workers: ['browser', workers],
  stages: ['browser', stages],
  scaling: ['browser', ({ scaling }) => (scaling ? [pixels(scaling), motions(scaling)].join('\n\n') : '')],
  page: ['page', page],
  ratio: ['ratio', nativeRatio],
};

function downloads({ wasmGzip, jsGzip, readyMs, peers, peersReadyMs }) {
  const rows = [['Veronese', `${kib(wasmGzip)} + ${kib(jsGzip)} JavaScript`, amount(readyMs)]];
  if (peers) {
    rows.push([`OpenCV.js ${peers.opencv.version}`, kib(peers.opencv.gzip), amount(peersReadyMs.opencv)]);
    rows.push([`jsfeat ${peers.jsfeat.version}`, kib(peers.jsfeat.gzip), amount(peersReadyMs.jsfeat)]);
  }
  return table(['', 'download, gzip', 'ready after, ms'], rows);
}

/** `first`: on a fresh page; `overlap`: mean IoU of the true labels and the labels found. */
function calls({ sizes }) {
  const rows = Object.entries(sizes).flatMap(([pixels, cases]) =>
    Object.entries(cases).map(([name, { median, best, first, overlap, memoryBytes }]) => [
      size(pixels),
      TITLES[name],
      amount(median),
      amount(best),
      first ? beside(first, median) : '',
      ratioToFlow(name, cases),
      overlap === undefined ? '' : score(overlap),
      memoryBytes ? mib(memoryBytes) : '',
    ]),
  );
  return table(['frames', 'call', 'median', 'best', 'first call', '÷ Farneback', 'overlap', 'memory, MiB'], rows);
}

/** Farneback’s flow is computed on the same frames: those of the pair, or of the clip. */
function ratioToFlow(name, cases) {
  const flow = name.startsWith('clip') ? cases.clipFlow : cases.farneback;
  return flow ? ratio(cases[name].median / flow.median) : '';
}

/** Whole clips. The first frame's masks are measured in frames of one worker. */
function workers({ sizes, workers: { size: pixels, rows } }) {
  const flow = sizes[pixels].clipFlow?.median;
  const lines = rows.map(({ quality, jobs, perFrame, first }) => {
    const one = rows.find((row) => row.quality === quality && row.jobs === 1).perFrame;
    const cells = [quality, String(jobs), amount(perFrame), ratio(one / perFrame), amount(first), (first / one).toFixed(1)];
    return [...cells, flow === undefined ? '' : ratio(perFrame / flow)];
  });
  const head = ['quality', 'workers', 'a frame', 'times as fast', 'first masks after', 'in frames of one worker', '÷ Farneback'];
  return `Frames of ${size(pixels)} pixels.\n\n${table(head, lines)}`;
}

/** Medians of the same source in native code and in the browser, alternating on the same frames. */
function stages({ sizes }) {
  const names = Object.keys(Object.values(sizes)[0].fast.stages);
  const rows = Object.entries(sizes).flatMap(([pixels, cases]) =>
    QUALITIES.flatMap((quality) => {
      const { median, stages, native } = cases[quality];
      const browser = [median, ...names.map((name) => stages[name] ?? 0)];
      const alone = [native.median, ...names.map((name) => native.stages[name] ?? 0)];
      return [
        [size(pixels), quality, 'native', ...alone.map(amount)],
        ['', '', 'browser', ...browser.map(amount)],
        ['', '', 'ratio', ...browser.map((value, k) => (alone[k] > 0 ? ratio(value / alone[k]) : ''))],
      ];
    }),
  );
  return table(['frames', 'quality', '', 'total', ...names], rows);
}

function pixels({ pixels, exponents }) {
  const rows = pixels.map(({ size: pixels, megapixels, fast, best, memory }) => [
    size(pixels),
    fixed(megapixels, 2),
    amount(fast),
    amount(best),
    mib(memory.fast),
    mib(memory.best),
  ]);
  const { fast, best, memoryFast, memoryBest } = exponents.pixels;
  rows.push(['exponent above half a megapixel', '', ...[fast, best, memoryFast, memoryBest].map((value) => fixed(value, 2))]);
  return table(['frames', 'megapixels', 'fast', 'best', 'memory, fast, MiB', 'memory, best, MiB'], rows);
}

function motions({ size: pixels, motions, exponents }) {
  const rows = motions.map(({ motions: n, fast, best }) => [String(n), amount(fast), amount(best)]);
  rows.push(['exponent', fixed(exponents.motions.fast, 2), fixed(exponents.motions.best, 2)]);
  return `With a given number of motions, ${size(pixels)} pixels:\n\n${table(['motions', 'fast', 'best'], rows)}`;
}

function page({ frames, size: pixels, quality, workers, seconds, opened, samples, done, stepped, tasks, first, corrected, ...figures }) {
  const perSecond = fixed(frames / seconds, 1);
  const at = Array.from({ length: ROWS }, (_, k) => samples[Math.floor(((k + 1) / ROWS) * (samples.length - 1))]);
  const memory = [['opened', opened], ...at.map(({ seconds, bytes }) => [`after ${fixed(seconds, 0)} s`, bytes]), ['segmented', done], ['after steps to 32 other frames', stepped]];
  const parts = [
    `${origin(figures)} ${frames} frames of ${size(pixels)} pixels, quality *${quality}*, ${workers} workers: ${fixed(seconds, 0)} s, ${perSecond} frames a second.`,
    table(['', 'memory of the browser, MiB'], memory.map(([name, bytes]) => [name, mib(bytes)])),
  ];
  const waits = [];
  if (first) waits.push(['first visit: the module is there', first.module], ['first visit: masks are drawn', first.masks], ['first visit: the clip is found', first.found]);
  if (corrected) {
    waits.push(['a stroke is drawn', corrected.stroke.median, corrected.stroke.worst], ['the corrected frame is drawn', corrected.frame.median, corrected.frame.worst]);
    waits.push(['all frames are corrected', corrected.clip.median, corrected.clip.worst]);
  }
  if (waits.length > 0) parts.push(table(['until', 'median, ms', 'worst, ms'], waits.map(([name, median, worst]) => [name, amount(median), worst === undefined ? '' : amount(worst)])));
  const blocking = Object.entries({ ...tasks, ...(corrected?.painting && { painting: corrected.painting }) });
  if (blocking.length > 0) parts.push(table(['tasks above 50 ms while', 'number', 'longest, ms'], blocking.map(([name, { count, longest }]) => [name, count, amount(longest)])));
  return parts.join('\n\n');
}

/** Native code and WebAssembly in Node on the same problems. */
function nativeRatio({ rows, ...figures }) {
  const spread = ([low, middle, high]) => `${amount(middle)} [${amount(low)}, ${amount(high)}]`;
  const lines = rows.map(({ call, native, wasm }) => [CALLS[call], spread(native), spread(wasm), ratio(wasm[1] / native[1])]);
  return `${origin(figures)} Milliseconds, median [quartiles].\n\n${table(['call', 'native', 'WebAssembly in Node', 'ratio'], lines)}`;
}

/** A time, and its ratio to another time. */
function beside(value, other) {
  return `${amount(value)} (${fixed(value / other, 1)} ×)`;
}

function kib(bytes) {
  return `${fixed(bytes / 1024, 0)} KiB`;
}

function mib(bytes) {
  return fixed(bytes / 2 ** 20, 0);
}
