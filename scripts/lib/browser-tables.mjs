// Formats the results of `npm run bench:browser` as Markdown tables, for the terminal and for docs/performance.md.

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

/** The parts of a report by name, without those that were not measured. */
export function partsOf(report) {
  return {
    browser: [origin(report), downloads(report), calls(report), workers(report)].join('\n\n'),
    stages: stages(report),
    ...(report.scaling && { scaling: [pixels(report.scaling), motions(report.scaling)].join('\n\n') }),
  };
}

function origin({ machine, rounds, date }) {
  const { processor, cores, chromium } = machine;
  return `${processor}, ${cores} cores, Chromium ${chromium}, ${date}: ${rounds} alternating calls of each kind on one thread; times in milliseconds.`;
}

function downloads({ wasmGzip, jsGzip, readyMs, peers, peersReadyMs }) {
  const rows = [['Veronese', `${kib(wasmGzip)} + ${kib(jsGzip)} JavaScript`, ms(readyMs)]];
  if (peers) {
    rows.push([`OpenCV.js ${peers.opencv.version}`, kib(peers.opencv.gzip), ms(peersReadyMs.opencv)]);
    rows.push([`jsfeat ${peers.jsfeat.version}`, kib(peers.jsfeat.gzip), ms(peersReadyMs.jsfeat)]);
  }
  return table(['', 'download, gzip', 'ready after'], rows);
}

/** `first`: on a fresh page; `overlap`: mean IoU of the true labels and the labels found. */
function calls({ sizes }) {
  const rows = Object.entries(sizes).flatMap(([size, cases]) =>
    Object.entries(cases).map(([name, { median, best, first, overlap, memoryBytes }]) => [
      times(size),
      TITLES[name],
      ms(median),
      ms(best),
      first ? beside(first, median) : '',
      ratioToFlow(name, cases),
      overlap === undefined ? '' : overlap.toFixed(3),
      memoryBytes ? mib(memoryBytes) : '',
    ]),
  );
  return table(['frames', 'call', 'median', 'best', 'first call', '÷ Farneback', 'overlap', 'memory, MiB'], rows);
}

/** Farneback’s flow is computed on the same frames: those of the pair, or of the clip. */
function ratioToFlow(name, cases) {
  const flow = name.startsWith('clip') ? cases.clipFlow : cases.farneback;
  return flow ? (cases[name].median / flow.median).toFixed(2) : '';
}

/** Whole clips. The first frame's masks are measured in frames of one worker. */
function workers({ sizes, workers: { size, rows } }) {
  const flow = sizes[size].clipFlow?.median;
  const lines = rows.map(({ quality, jobs, perFrame, first }) => {
    const one = rows.find((row) => row.quality === quality && row.jobs === 1).perFrame;
    const cells = [quality, String(jobs), ms(perFrame), (one / perFrame).toFixed(2), ms(first), (first / one).toFixed(1)];
    return [...cells, flow === undefined ? '' : (perFrame / flow).toFixed(2)];
  });
  const head = ['quality', 'workers', 'a frame', 'times as fast', 'first masks after', 'in frames of one worker', '÷ Farneback'];
  return `Whole clips of ${times(size)} pixels, with the same masks whatever the number of workers:\n\n${table(head, lines)}`;
}

/** Medians of the same source in native code and in the browser, alternating on the same frames. */
function stages({ sizes }) {
  const names = Object.keys(Object.values(sizes)[0].fast.stages);
  const rows = Object.entries(sizes).flatMap(([size, cases]) =>
    QUALITIES.flatMap((quality) => {
      const { median, stages, native } = cases[quality];
      const browser = [median, ...names.map((name) => stages[name] ?? 0)];
      const alone = [native.median, ...names.map((name) => native.stages[name] ?? 0)];
      return [
        [times(size), quality, 'native', ...alone.map(ms)],
        ['', '', 'browser', ...browser.map(ms)],
        ['', '', 'ratio', ...browser.map((value, k) => (alone[k] > 0 ? (value / alone[k]).toFixed(2) : ''))],
      ];
    }),
  );
  return table(['frames', 'quality', '', 'total', ...names], rows);
}

function pixels({ pixels, exponents }) {
  const rows = pixels.map(({ size, megapixels, fast, best, memory }) => [
    times(size),
    megapixels.toFixed(2),
    ms(fast),
    ms(best),
    mib(memory.fast),
    mib(memory.best),
  ]);
  const { fast, best, memoryFast, memoryBest } = exponents.pixels;
  rows.push(['exponent above half a megapixel', '', power(fast), power(best), power(memoryFast), power(memoryBest)]);
  return table(['frames', 'megapixels', 'fast', 'best', 'memory, fast, MiB', 'memory, best, MiB'], rows);
}

function motions({ size, motions, exponents }) {
  const rows = motions.map(({ motions: n, fast, best }) => [String(n), ms(fast), ms(best)]);
  rows.push(['exponent', power(exponents.motions.fast), power(exponents.motions.best)]);
  return `With a given number of motions, ${times(size)} pixels:\n\n${table(['motions', 'fast', 'best'], rows)}`;
}

function table(head, rows) {
  return [head, head.map(() => '---'), ...rows].map((cells) => `| ${cells.join(' | ')} |`).join('\n');
}

function ms(value) {
  return value.toFixed(value < 1000 ? 1 : 0);
}

/** A time, and its ratio to another time. */
function beside(value, other) {
  return `${ms(value)} (${(value / other).toFixed(1)} ×)`;
}

function kib(bytes) {
  return `${(bytes / 1024).toFixed(1)} KiB`;
}

function mib(bytes) {
  return (bytes / 2 ** 20).toFixed(1);
}

function power(value) {
  return value.toFixed(2);
}

/** Formats "640x480" as "640 × 480". */
function times(size) {
  return size.replace('x', ' × ');
}
