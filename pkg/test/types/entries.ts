// The entries have the hand-written types; compiled, never run.

import * as codecs from '../../src/entries/codecs.js';
import * as colours from '../../src/entries/colours.js';
import { VeroneseSegmenterElement } from '../../src/element/element-class.js';
import * as formats from '../../src/formats/index.js';
import * as inline from '../../src/entries/inline.js';
import * as node from '../../src/entries/node.js';
import * as slim from '../../src/entries/slim.js';
import * as web from '../../src/entries/web.js';

export const entries: (typeof import('veronese'))[] = [node, web];
export const partial: (typeof import('veronese/slim'))[] = [slim, inline];
export const same: typeof import('veronese/inline') = inline;
export const files: typeof import('veronese/codecs') = codecs;
export const looks: typeof import('veronese/colours') = colours;
export const masks: typeof import('veronese/formats') = formats;
export const element: typeof import('veronese/element-class').VeroneseSegmenterElement = VeroneseSegmenterElement;
