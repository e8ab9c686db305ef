// A worker of the page's own that segments by itself. Import maps do not reach into workers: the place is written out.

import { segmentPair } from './node_modules/veronese/dist/web.js';
import { first, second } from './frames.js';
import { report } from './report.js';

postMessage(await segmentPair(first, second).then(report, (error) => `${error.code}: ${error.message}`));
