// The first calls in a new worker, for Node and browsers alike; see scripts/bench-first.mjs.

/**
 * Milliseconds of calls one after another, from when there are frames. `ahead`: milliseconds for which the worker has been warming up by
 * then, 'whole' for as long as it takes, null for not at all.
 */
export async function firstCalls(Segmenter, { first, second }, { calls, ahead }) {
  const segmenter = new Segmenter();
  const warm = ahead === null ? undefined : segmenter.warmUp();
  if (ahead === 'whole') await warm;
  else if (ahead !== null) await new Promise((resolve) => setTimeout(resolve, ahead));
  const times = [];
  while (times.length < calls) {
    const start = performance.now();
    await segmenter.segmentPair(first, second, { quality: 'fast' });
    times.push(performance.now() - start);
  }
  segmenter.close();
  return times;
}

/** The frames of a size ("640x480"), where `read` gives the bytes of a file. */
export async function pairOf(size, read) {
  const [width, height] = size.split('x').map(Number);
  const frame = async (which) => ({ data: await read(`${which}-${size}`), width, height });
  return { first: await frame('first'), second: await frame('second') };
}
