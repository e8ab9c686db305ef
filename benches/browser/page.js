// The page of `npm run bench -- browser`. Everything timed runs here on the main thread; the script calls it from outside.

import { farneback, loadOpenCv, openCvPipeline } from './opencv.js';

/** Frames of a clip that are not counted: the first ones are searched without anything known. */
const UNCOUNTED = 4;
const frames = new Map();
let veronese;

/** The cases: `load` prepares one, `run` is a call. */
const CASES = {
  fast: { load: loadVeronese, run: ({ first, second }) => veronese.segmentPair(first, second, { quality: 'fast' }) },
  best: { load: loadVeronese, run: ({ first, second }) => veronese.segmentPair(first, second, { quality: 'best' }) },
  farneback: { load: loadOpenCv, run: farneback },
  opencvPipeline: { load: loadOpenCv, run: openCvPipeline },
  clip: { load: loadVeronese, run: followClip },
  clipFlow: { load: loadOpenCv, run: clipFlow },
};

globalThis.bench = {
  /** Milliseconds until a case can be called. */
  async load(name) {
    const start = performance.now();
    await CASES[name].load();
    return performance.now() - start;
  },

  /** Fetches the frames of a size ("640x480"), their true labels, and a clip. */
  async prepare(size) {
    const [width, height] = size.split('x').map(Number);
    const bytes = async (what) => new Uint8Array(await (await fetch(`/out/bench/frames/${what}-${size}`)).arrayBuffer());
    const image = async (what) => new ImageData(new Uint8ClampedArray((await bytes(what)).buffer), width, height);
    const all = new Uint8ClampedArray((await bytes('clip')).buffer);
    const clip = Array.from(
      { length: all.length / (4 * width * height) },
      (_, t) => new ImageData(all.subarray(4 * width * height * t, 4 * width * height * (t + 1)), width, height),
    );
    frames.set(size, { first: await image('first'), second: await image('second'), truth: await bytes('labels'), clip });
  },

  /** A call: its milliseconds (of a clip, the median of a frame), the number of its motions, and the mean overlap of its labels with the true ones. */
  async run(name, size) {
    const pair = frames.get(size);
    const start = performance.now();
    const result = await CASES[name].run(pair);
    const milliseconds = result?.perFrame ?? performance.now() - start;
    const overlap = result?.labels && pair.truth ? meanOverlap(pair.truth, result.labels) : undefined;
    return { milliseconds, count: result?.count, overlap };
  },

  /** Memory of a new instance after one call, bytes. */
  async memory(quality, size) {
    const { glue } = await import('/pkg/build/module/glue.js');
    const response = await fetch('/pkg/wasm/veronese_bg.wasm');
    const { memory } = await glue.instantiate(await WebAssembly.compileStreaming(response));
    const { first, second } = frames.get(size);
    glue.segmentPair(first, second, { quality }, undefined);
    return memory.buffer.byteLength;
  },
};

async function loadVeronese() {
  veronese ??= await import('/pkg/dist/web.js');
  await veronese.init();
}

/** Follows the objects of a clip as from a slow camera: the next frame comes when the one before is labelled. */
async function followClip({ clip }) {
  const times = [];
  let start;
  let isLabelled;
  let labelled;
  async function* camera() {
    for (const frame of clip) {
      await isLabelled;
      isLabelled = new Promise((resolve) => (labelled = resolve));
      start = performance.now();
      yield frame;
    }
  }
  for await (const { labels } of veronese.segmentStream(camera(), { quality: 'fast', lookAhead: 0 })) {
    if (labels.length > 0) times.push(performance.now() - start);
    labelled();
  }
  return { perFrame: ofFrame(times) };
}

/** Only the flow between the frames of a clip. */
function clipFlow({ clip }) {
  const times = clip.slice(1).map((second, t) => {
    const start = performance.now();
    farneback({ first: clip[t], second });
    return performance.now() - start;
  });
  return { perFrame: ofFrame(times) };
}

/** Median of the frames that count. */
function ofFrame(times) {
  const counted = times.slice(UNCOUNTED).sort((a, b) => a - b);
  return counted[Math.floor(counted.length / 2)];
}

/** Intersection over union of each true label with the best found label, averaged over the true labels. */
function meanOverlap(truth, labels) {
  const both = new Map();
  const [ofTruth, ofLabels] = [new Map(), new Map()];
  const count = (map, key) => map.set(key, (map.get(key) ?? 0) + 1);
  for (let p = 0; p < truth.length; p += 1) {
    count(both, truth[p] * 256 + labels[p]);
    count(ofTruth, truth[p]);
    count(ofLabels, labels[p]);
  }
  let sum = 0;
  for (const [t, inTruth] of ofTruth) {
    let best = 0;
    for (const [l, inLabels] of ofLabels) {
      const common = both.get(t * 256 + l) ?? 0;
      best = Math.max(best, common / (inTruth + inLabels - common));
    }
    sum += best;
  }
  return sum / ofTruth.size;
}
