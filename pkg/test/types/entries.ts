// The entries are what the hand-written types say; compiled, never run.

import * as codecs from '../../src/codecs.js';
import * as formats from '../../src/formats/index.js';
import * as node from '../../src/node.js';
import * as web from '../../src/web.js';

export const entries: (typeof import('veronese'))[] = [node, web];
export const files: typeof import('veronese/codecs') = codecs;
export const masks: typeof import('veronese/formats') = formats;
