// The bits of what the package answers: plain JavaScript, for Node and the page. The order of the numbers is that of
// experiments/same-bits.rs and bits.py.

/** Answers a case with `{ labels, numbers }`, SHA-256 of all labels and of all numbers. `read` gives the RGBA bytes of a file. */
export async function bitsOf({ segmentPair, segmentClip }, { width, height, frames, clip, options }, read) {
  const frame = async (file) => ({ data: await read(file), width, height });
  if (!clip) {
    const found = await segmentPair(await frame(frames[0]), await frame(frames[1]), options);
    return hashed(found.labels, numbersOfPair(found));
  }
  async function* each() {
    for (const file of frames) yield frame(file);
  }
  // A list of frames is a whole clip; what comes one by one is a stream.
  const input = options.lookAhead === undefined ? { length: frames.length, read: (index) => frame(frames[index]) } : each();
  const labels = [];
  const numbers = [];
  for await (const found of segmentClip(input, options)) {
    labels.push(...found.labels);
    numbers.push(...numbersOfFrame(found));
  }
  return hashed(Uint8Array.from(labels), numbers);
}

function numbersOfPair({ motions, junctions, evidence, confidence }) {
  return [
    motions.map(({ label, matrix, pixels, share, residual, bbox, group }) => [label, matrix, pixels, share, residual, bbox, group]),
    junctions.map(({ labels, likelihood, border }) => [labels, likelihood, border]),
    evidence.candidates.map(({ motions: count, score }) => [count, score]),
    confidence ? [...confidence] : [],
  ].flat(Infinity);
}

function numbersOfFrame({ index, objects, background }) {
  const ofObjects = objects.map(({ id, pixels, bbox, confidence, matrix }) => [id, pixels, bbox, confidence, perhaps(matrix)]);
  return [index, ofObjects, perhaps(background)].flat(Infinity);
}

/** 0 for no motion; 1 and its entries for one. */
const perhaps = (matrix) => (matrix ? [1, ...matrix] : [0]);

/** The hashes of labels and of numbers as 64 bits, the low byte first. */
export async function hashed(labels, numbers) {
  const bytes = new DataView(new ArrayBuffer(8 * numbers.length));
  numbers.forEach((value, k) => bytes.setFloat64(8 * k, value, true));
  return { labels: await sha256(labels), numbers: await sha256(bytes) };
}

export async function sha256(bytes) {
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
  return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
}
