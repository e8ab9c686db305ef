// The one function behind every host: two image files in, labels and motions out.

import { SegmenterPool } from 'veronese';
import { decodeImage } from 'veronese/codecs';

/** A function that segments pairs of image files in worker threads, so that the server answers meanwhile; `close()` ends them. */
export function createSegment({ jobs } = {}) {
  const pool = new SegmenterPool(jobs === undefined ? {} : { jobs });
  const segment = async (firstFile, secondFile, options = {}) => {
    const [first, second] = [await decodeImage(firstFile), await decodeImage(secondFile)];
    return pool.segmentPair(first, second, options);
  };
  return { segment, close: () => pool.close() };
}

/**
 * How sure the result is as a whole, from 0 to 1: the mean probability that a pixel's label is right.
 * Needs `confidence: true` among the options.
 */
export function score({ confidence }) {
  return confidence.reduce((sum, value) => sum + value, 0) / (255 * confidence.length);
}
