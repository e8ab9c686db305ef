// Plain Node.

import { fitMotions, Segmenter, segmentPair, segmentPairs } from 'veronese';
import { decodeImage, encodePng } from 'veronese/codecs';
import { first, second } from './frames.js';
import { measurements } from './measurements.js';
import { report } from './report.js';

const direct = report(await segmentPair(first, second));
const inWorker = report(await new Segmenter().segmentPair(first, second));
const fits = [report(await fitMotions(measurements)), report(await new Segmenter().fitMotions(measurements))];
const pooled = [];
for await (const { segmentation } of segmentPairs([{ first, second }, { first, second }])) pooled.push(report(segmentation));
const { width } = await decodeImage(await encodePng(16, 16, new Uint8Array(256)));
if (width !== 16) throw new Error('the codecs do not work');
console.log(JSON.stringify({ direct, inWorker, pooled, fits }));
