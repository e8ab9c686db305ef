// `veronese/element/inline`: the element with its modules and its worker inside, for pages of one file and bundlers that lose files.

import { SegmenterPool } from '../entries/inline.js';
import { VeroneseSegmenterElement } from './element.js';
import { code } from './inline-worker.js';

export { VeroneseSegmenterElement } from './element.js';

VeroneseSegmenterElement.Pool = SegmenterPool;
VeroneseSegmenterElement.worker = () =>
  new Worker(URL.createObjectURL(new Blob([code], { type: 'text/javascript' })), { name: 'veronese' });
