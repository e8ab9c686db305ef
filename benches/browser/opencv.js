// Motion masks with OpenCV.js: dense flow by Farneback's method with the parameters of OpenCV's tutorial, affine motions one by one by
// RANSAC on the flow at a grid of pixels, then the label of the motion nearest to the flow for every pixel, and a median filter.

/** Spacing of the grid, pixels. */
const GRID = 8;
/** Maximum number of motions. */
const MOST = 6;
/** Inlier threshold of RANSAC, pixels. */
const NEAR = 1;
/** Smallest share of grid pixels of a motion. */
const SMALLEST_SHARE = 0.02;
/** Side of the median filter, pixels. */
const MEDIAN = 13;

let cv;

export async function loadOpenCv() {
  if (cv) return;
  await new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = '/.tools/peers/node_modules/@techstark/opencv-js/dist/opencv.js';
    script.onload = resolve;
    script.onerror = () => reject(new Error('OpenCV.js could not be loaded'));
    document.head.append(script);
  });
  cv = await globalThis.cv;
}

/** Computes the flow only. */
export function farneback(pair) {
  flowOf(pair).delete();
}

function flowOf({ first, second }) {
  const grey = (frame) => {
    const rgba = cv.matFromImageData(frame);
    const plane = new cv.Mat();
    cv.cvtColor(rgba, plane, cv.COLOR_RGBA2GRAY);
    rgba.delete();
    return plane;
  };
  const [one, two, flow] = [grey(first), grey(second), new cv.Mat()];
  cv.calcOpticalFlowFarneback(one, two, flow, 0.5, 3, 15, 3, 5, 1.2, 0);
  one.delete();
  two.delete();
  return flow;
}

/** The labels of the first frame. */
export function openCvPipeline(pair) {
  const { width, height } = pair.first;
  const flow = flowOf(pair);
  const motions = sequentialAffine(flow.data32F, width, height);
  const labels = nearestMotion(flow.data32F, width, height, motions);
  flow.delete();
  return { labels: smoothed(labels, width, height), count: motions.length };
}

/** Affine maps [a b c; d e f] from x to x + flow, each fitted to the grid pixels that the earlier ones leave over. */
function sequentialAffine(flow, width, height) {
  let points = [];
  for (let y = GRID / 2; y < height; y += GRID) for (let x = GRID / 2; x < width; x += GRID) points.push(y * width + x);
  const smallest = SMALLEST_SHARE * points.length;
  const motions = [];
  while (motions.length < MOST && points.length > Math.max(smallest, 3)) {
    const from = cv.matFromArray(
      points.length,
      1,
      cv.CV_32FC2,
      points.flatMap((p) => [p % width, Math.floor(p / width)]),
    );
    const moved = points.flatMap((p) => [(p % width) + flow[2 * p], Math.floor(p / width) + flow[2 * p + 1]]);
    const to = cv.matFromArray(points.length, 1, cv.CV_32FC2, moved);
    const inliers = new cv.Mat();
    const matrix = cv.estimateAffine2D(from, to, inliers, cv.RANSAC, NEAR, 2000, 0.99, 10);
    const found = matrix.rows === 2 && cv.countNonZero(inliers) >= smallest;
    if (found) {
      motions.push(Array.from(matrix.data64F));
      points = points.filter((_, k) => inliers.data[k] === 0);
    }
    for (const mat of [from, to, inliers, matrix]) mat.delete();
    if (!found) break;
  }
  return motions;
}

function nearestMotion(flow, width, height, motions) {
  const labels = new Uint8Array(width * height);
  for (let y = 0, p = 0; y < height; y += 1) {
    for (let x = 0; x < width; x += 1, p += 1) {
      let nearest = Infinity;
      for (let k = 0; k < motions.length; k += 1) {
        const [a, b, c, d, e, f] = motions[k];
        const [du, dv] = [a * x + b * y + c - x - flow[2 * p], d * x + e * y + f - y - flow[2 * p + 1]];
        const distance = du * du + dv * dv;
        if (distance < nearest) [nearest, labels[p]] = [distance, k];
      }
    }
  }
  return labels;
}

function smoothed(labels, width, height) {
  const [from, to] = [cv.matFromArray(height, width, cv.CV_8UC1, labels), new cv.Mat()];
  cv.medianBlur(from, to, MEDIAN);
  const result = to.data.slice();
  from.delete();
  to.delete();
  return result;
}
