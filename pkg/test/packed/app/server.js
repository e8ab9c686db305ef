// A page that is first made on a server, as Next does: the server imports everything that the browser will.

import { Segmenter, segmentPair, SegmenterPool } from 'veronese';
import { first, second } from './frames.js';
import { report } from './report.js';

export function render() {
  return `<p>${typeof Segmenter} ${typeof SegmenterPool}</p>`;
}

export const segment = async () => report(await segmentPair(first, second));
