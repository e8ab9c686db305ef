// The tables of docs/performance.md.

import { amount, fixed, origin, ratio, score, size, table } from './table.mjs';

const TITLES = {
  fast: '`segmentPair`, fast',
  best: '`segmentPair`, best',
  farneback: 'OpenCV.js, Farneback’s flow alone',
  opencvPipeline: 'OpenCV.js, flow to labels',
  clip: '`segmentStream`, fast, `lookAhead: 0`, a frame',
};

export const PARTS = {
  browser: [
    'browser',
    (report) => [`${origin(report)} ${report.rounds} calls of each kind.`, downloads(report), calls(report)].join('\n\n'),
  ],
  page: ['page', page],
};

function downloads({ wasmGzip, jsGzip, readyMs, peers: { opencv }, peersReadyMs }) {
  const rows = [
    ['Veronese', `${kib(wasmGzip)} + ${kib(jsGzip)} JavaScript`, amount(readyMs)],
    [`OpenCV.js ${opencv.version}`, kib(opencv.gzip), amount(peersReadyMs.opencv)],
  ];
  return table(['', 'download, gzip', 'ready after, ms'], rows);
}

/** `first`: on a fresh page; `overlap`: mean IoU of the true labels and the labels found. */
function calls({ sizes }) {
  const rows = Object.entries(sizes).flatMap(([pixels, cases]) =>
    Object.entries(cases)
      .filter(([name]) => name in TITLES)
      .map(([name, { median, native, first, overlap, memoryBytes }]) => [
        size(pixels),
        TITLES[name],
        amount(median),
        native ? amount(native) : '',
        first ? amount(first) : '',
        ratioToFlow(name, cases),
        overlap === undefined ? '' : score(overlap),
        memoryBytes ? mib(memoryBytes) : '',
      ]),
  );
  return table(['frames', 'call', 'median', 'native', 'first call', '÷ Farneback', 'overlap', 'memory, MiB'], rows);
}

/** Farneback’s flow is computed on the same frames: those of the pair, or of the clip. */
function ratioToFlow(name, cases) {
  const flow = name.startsWith('clip') ? cases.clipFlow : cases.farneback;
  return flow ? ratio(cases[name].median / flow.median) : '';
}

function page({ frames, size: pixels, quality, workers, seconds, memory, tasks, first, corrected, ...figures }) {
  const { module, masks, found } = first;
  const { stroke, frame, clip } = corrected;
  const waits = [
    ['first visit: the module is there', module],
    ['first visit: masks are drawn', masks],
    ['first visit: the clip is found', found],
    ['a stroke is drawn', stroke.median, stroke.worst],
    ['the corrected frame is drawn', frame.median, frame.worst],
    ['all frames are corrected', clip.median, clip.worst],
  ];
  const blocking = Object.entries(tasks).map(([name, { count, longest }]) => [name, count, amount(longest)]);
  return [
    `${origin(figures)} ${frames} frames of ${size(pixels)} pixels, quality *${quality}*, ${workers} workers: ${fixed(seconds, 0)} s, ${fixed(frames / seconds, 1)} frames a second.`,
    table(
      ['', 'memory of the browser, MiB'],
      Object.entries(memory).map(([when, bytes]) => [when, mib(bytes)]),
    ),
    table(
      ['until', 'median, ms', 'worst, ms'],
      waits.map(([name, median, worst]) => [name, amount(median), worst === undefined ? '' : amount(worst)]),
    ),
    table(['tasks above 50 ms while', 'number', 'longest, ms'], blocking),
  ].join('\n\n');
}

function kib(bytes) {
  return `${fixed(bytes / 1024, 0)} KiB`;
}

function mib(bytes) {
  return fixed(bytes / 2 ** 20, 0);
}
