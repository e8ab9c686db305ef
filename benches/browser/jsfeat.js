// jsfeat has no dense flow. The nearest it has is tracking of corners by the method of Lucas and Kanade.

const CORNERS = 500;
const LEVELS = 3;
const WINDOW = 15;

let jsfeat;

export async function loadJsfeat() {
  if (jsfeat) return;
  await new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = '/.tools/peers/node_modules/jsfeat/build/jsfeat-min.js';
    script.onload = resolve;
    script.onerror = () => reject(new Error('jsfeat could not be loaded'));
    document.head.append(script);
  });
  jsfeat = globalThis.jsfeat;
}

/** The number of corners of the first frame that are found in the second; no labels. */
export function trackCorners({ first, second }) {
  const { width, height } = first;
  const pyramid = ({ data }) => {
    const levels = new jsfeat.pyramid_t(LEVELS);
    levels.allocate(width, height, jsfeat.U8_t | jsfeat.C1_t);
    jsfeat.imgproc.grayscale(data, width, height, levels.data[0]);
    levels.build(levels.data[0], true);
    return levels;
  };
  const [one, two] = [pyramid(first), pyramid(second)];
  const corners = Array.from({ length: width * height }, () => new jsfeat.keypoint_t(0, 0, 0, 0));
  jsfeat.fast_corners.set_threshold(20);
  const found = jsfeat.fast_corners.detect(one.data[0], corners, 8);
  const chosen = corners.slice(0, found).sort((a, b) => b.score - a.score).slice(0, CORNERS);
  const from = new Float32Array(chosen.flatMap(({ x, y }) => [x, y]));
  const to = new Float32Array(from.length);
  const status = new Uint8Array(chosen.length);
  jsfeat.optical_flow_lk.track(one, two, from, to, chosen.length, WINDOW, 30, status, 0.01, 0.001);
  return { count: status.reduce((sum, s) => sum + s, 0) };
}
