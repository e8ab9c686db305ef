// Values for the arguments of the public entries that do not belong there: for hostile.test.mjs.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import * as index from 'veronese';
import { pair, points } from './frames.mjs';
import { timeless } from './shapes.mjs';

const TYPES = new URL('../../types/index.d.ts', import.meta.url);
const CODES = readFileSync(TYPES, 'utf8').match(/ErrorCode =[^;]+;/)[0].match(/'[a-z-]+'/g).map((code) => code.slice(1, -1));

const detached = (array) => {
  structuredClone(array.buffer, { transfer: [array.buffer] });
  return array;
};
const shrunk = (Kind) => {
  const buffer = new ArrayBuffer(4096, { maxByteLength: 8192 });
  const array = new Kind(buffer, 1024, 16);
  buffer.resize(512);
  return array;
};
const revoked = () => {
  const { proxy, revoke } = Proxy.revocable({}, {});
  revoke();
  return proxy;
};
const throwing = new Proxy({}, {
  get: () => { throw new RangeError('mine'); },
  ownKeys: () => { throw new RangeError('mine'); },
});

/** The values by name. */
export const VALUES = {
  undefined: undefined,
  null: null,
  true: true,
  false: false,
  zero: 0,
  'minus one': -1,
  one: 1,
  half: 0.5,
  NaN: NaN,
  Infinity: Infinity,
  '300': 300,
  'more than 32 bits': 2 ** 32 + 16,
  'more than 53 bits': 2 ** 60,
  bigint: 1n,
  'empty text': '',
  text: 'text',
  symbol: Symbol('text'),
  function: () => 5,
  'empty list': [],
  'list of null': [null],
  'sparse list': Array(3),
  'empty object': {},
  'object without prototype': Object.create(null),
  'object with a function': { made: () => 5 },
  cyclic: (() => { const value = {}; value.value = value; return value; })(),
  throwing,
  'revoked proxy': revoked(),
  date: new Date(0),
  map: new Map([[1, 2]]),
  promise: Promise.resolve(1),
  'like a signal': { aborted: false },
  'like a worker': { postMessage() {} },
  'no bytes': new Uint8Array(0),
  'three bytes': Uint8Array.of(1, 2, 3),
  'detached bytes': detached(new Uint8Array(16 * 16 * 4)),
  'detached words': detached(new Uint16Array(16 * 16)),
  'detached doubles': detached(new Float64Array(30)),
  'shrunk bytes': shrunk(Uint8Array),
  'shrunk words': shrunk(Uint16Array),
  'shrunk doubles': shrunk(Float64Array),
  'shared bytes': new Uint8Array(new SharedArrayBuffer(3)),
  floats: new Float32Array(16 * 16 * 4),
  'a buffer': new ArrayBuffer(16 * 16 * 4),
  'a data view': new DataView(new ArrayBuffer(16 * 16 * 4)),
  'bytes that are called something else': Object.defineProperty(new Uint8Array(16), Symbol.toStringTag, { value: 'Float64Array' }),
};
export const named = (fits) => Object.keys(VALUES).filter((name) => !/throwing|proxy/.test(name) && fits(VALUES[name]));
/** Objects without entries. */
export const EMPTY = named((value) => typeof value === 'object' && value !== null && !Array.isArray(value) && Object.keys(value).length === 0);
export const OPTIONS = ['undefined', ...EMPTY];
export const FINITE = named(Number.isFinite);

const size = { width: 16, height: 16 };
export const [first, second] = pair(size);
export const found = await index.segmentPair(first, second, { confidence: true });
export const measurements = points(40, 1, 2);

/**
 * The calls that a Segmenter has too: arguments with the value in one place, and the names of the values that may stand there. A
 * name that is not listed must be refused.
 */
export const CALLS = {
  'segmentPair: first': ['segmentPair', (v) => [v, second], []],
  'segmentPair: data': ['segmentPair', (v) => [{ ...first, data: v }, second], []],
  'segmentPair: height': ['segmentPair', (v) => [first, { ...second, height: v }], []],
  'segmentPair: options': ['segmentPair', (v) => [first, second, v], OPTIONS],
  'segmentPair: motions': ['segmentPair', (v) => [first, second, { motions: v }], ['undefined', 'one']],
  'segmentPair: quality': ['segmentPair', (v) => [first, second, { quality: v }], ['undefined']],
  'segmentPair: subject': ['segmentPair', (v) => [first, second, { subject: v }], ['undefined', 'true', 'false']],
  'segmentPair: markUnknown': ['segmentPair', (v) => [first, second, { markUnknown: v }], ['undefined', 'true', 'false']],
  'segmentPair: confidence': ['segmentPair', (v) => [first, second, { confidence: v }], ['undefined', 'true', 'false']],
  'segmentPair: signal': ['segmentPair', (v) => [first, second, { signal: v }], ['undefined']],
  'segmentPair: onProgress': ['segmentPair', (v) => [first, second, { onProgress: v }], ['undefined', 'function']],
  'segmentPair: transfer': ['segmentPair', (v) => [structuredClone(first), structuredClone(second), { transfer: v }], ['undefined', 'true', 'false']],
  'segmentPair: an option that does not exist': ['segmentPair', (v) => [first, second, { nonsense: v }], ['undefined']],
  'fitMotions: measurements': ['fitMotions', (v) => [v], []],
  'fitMotions: positions': ['fitMotions', (v) => [{ ...measurements, positions: v }], []],
  'fitMotions: options': ['fitMotions', (v) => [measurements, v], OPTIONS],
  'fitMotions: motions': ['fitMotions', (v) => [measurements, { motions: v }], ['undefined', 'one']],
  'fitMotions: method': ['fitMotions', (v) => [measurements, { method: v }], ['undefined']],
  'fitMotions: seed': ['fitMotions', (v) => [measurements, { seed: v }], ['undefined', 'zero', 'one', '300', 'more than 32 bits']],
};

/** The outcome of a call: its result, or the error's code and sentence. */
export async function outcome(call) {
  let result;
  try {
    result = await call();
  } catch (error) {
    assert.ok(error?.name === 'VeroneseError' && error instanceof index.VeroneseError, error?.stack ?? String(error));
    return checked(error);
  }
  return { result: result?.milliseconds ? timeless(result) : result };
}

export function checked({ code, message }) {
  assert.ok(CODES.includes(code) && code !== 'internal', `${code}: ${message}`);
  assert.match(message, /^[^\n]{10,}$/);
  return { code, message };
}

/** Everything that an iterator gives. */
export async function all(outcomes) {
  const list = [];
  for await (const { input, ...rest } of outcomes) list.push(rest);
  return list;
}

/** A value that cannot even be awaited or iterated is an error of the source, which is passed on as it is. */
const awaited = (value) => (value === VALUES.throwing || value === VALUES['revoked proxy'] ? undefined : value);
const iterated = (value) => (ArrayBuffer.isView(value) ? undefined : value);

/** The arguments of a stream, as those of the other calls. */
export const STREAMS = {
  frames: [(v) => [iterated(v)], []],
  'a frame': [(v) => [[first, awaited(v)]], []],
  data: [(v) => [[first, { ...second, data: v }]], []],
  options: [(v) => [[first, second], v], OPTIONS],
  lookAhead: [(v) => [[first, second], { lookAhead: v }], ['undefined', 'zero', 'one']],
  signal: [(v) => [[first, second], { signal: v }], ['undefined']],
  onProgress: [(v) => [[first, second], { onProgress: v }], ['undefined', 'function']],
  transfer: [(v) => [[structuredClone(first), structuredClone(second)], { transfer: v }], ['undefined', 'true', 'false']],
  markUnknown: [(v) => [[first, second], { markUnknown: v }], ['undefined', 'true', 'false']],
  'an option that does not exist': [(v) => [[first, second], { nonsense: v }], ['undefined']],
};

/** The arguments of openClip; the clip is closed again. */
export const OPENINGS = {
  frames: [(v) => [v], ['empty list', 'list of null', 'sparse list']],
  length: [(v) => [{ length: v, read: () => first }], ['zero', 'one', '300']],
  read: [(v) => [{ length: 2, read: v }], ['function']],
  options: [(v) => [[first, second], v], OPTIONS],
  journal: [(v) => [[first, second], { journal: v === 'text' ? undefined : v }], ['undefined', 'text']],
  saved: [(v) => [[first, second], { saved: v }], ['undefined']],
  markUnknown: [(v) => [[first, second], { markUnknown: v }], ['undefined', 'true', 'false']],
  maxSize: [(v) => [[first, second], { maxSize: v }], ['undefined', '300']],
  'an option that does not exist': [(v) => [[first, second], { nonsense: v }], ['undefined']],
};

/** Labels of a frame that are all left open. */
const OPEN = new Uint8Array(256).fill(255);

/** The arguments of what an open clip does. */
export const COMMANDS = {
  'segment: options': ['segment', (v) => [v], OPTIONS],
  'segment: first': ['segment', (v) => [{ first: v }], ['undefined', 'zero']],
  'segment: last': ['segment', (v) => [{ last: v }], ['undefined', 'one']],
  'segment: motions': ['segment', (v) => [{ motions: v }], ['undefined', 'one']],
  'segment: quality': ['segment', (v) => [{ quality: v }], ['undefined']],
  'segment: subject': ['segment', (v) => [{ subject: v }], ['undefined', 'true', 'false']],
  'segment: signal': ['segment', (v) => [{ signal: v }], ['undefined']],
  'segment: drafts': ['segment', (v) => [{ drafts: v }], ['undefined', 'true', 'false']],
  annotate: ['annotate', (v) => [v], []],
  'annotate: frame': ['annotate', (v) => [{ frame: v, labels: OPEN }], ['zero', 'one']],
  'annotate: propagate': ['annotate', (v) => [{ frame: 0, labels: OPEN, propagate: v }], ['undefined']],
  'annotate: labels': ['annotate', (v) => [{ frame: 0, labels: v }], []],
  'annotate: own': ['annotate', (v) => [{ frame: 0, labels: OPEN, own: v }], ['undefined', 'true', 'false']],
  'annotate: object': ['annotate', (v) => [{ frame: 0, object: v, strokes: OPEN }], ['one']],
  'annotate: strokes': ['annotate', (v) => [{ frame: 0, object: 1, strokes: v }], []],
  'annotate: mask': ['annotate', (v) => [{ frame: 0, object: 1, mask: v }], []],
  'annotate: clicks': ['annotate', (v) => [{ frame: 0, object: 1, clicks: v }], ['empty list']],
  'annotate: box': ['annotate', (v) => [{ frame: 0, object: 1, box: v }], []],
  clear: ['clear', (v) => [v], []],
  'clear: frame': ['clear', (v) => [{ frame: v }], ['zero', 'one']],
  'clear: object': ['clear', (v) => [{ frame: 0, object: v }], ['undefined', 'one']],
  accept: ['accept', (v) => [v], ['empty list']],
  'accept: on': ['accept', (v) => [[0], v], ['undefined', 'true', 'false']],
  lock: ['lock', (v) => [v, false], ['empty list']],
  'lock: on': ['lock', (v) => [[], v], ['undefined', 'true', 'false']],
  'describe: object': ['describe', (v) => [v, {}], ['one']],
  describe: ['describe', (v) => [1, v], EMPTY],
  'describe: name': ['describe', (v) => [1, { name: v }], ['undefined', 'empty text', 'text']],
  'describe: class': ['describe', (v) => [1, { class: v }], ['undefined', 'empty text', 'text']],
  'describe: colour': ['describe', (v) => [1, { colour: v }], ['undefined']],
  'describe: options': ['describe', (v) => [1, {}, v], OPTIONS],
  merge: ['merge', (v) => [1, v], []],
  delete: ['delete', (v) => [v], ['one']],
  'split: object': ['split', (v) => [v, 0], []],
  'split: frame': ['split', (v) => [1, v], []],
  replaceAnnotations: ['replaceAnnotations', (v) => [v], EMPTY],
  'replaceAnnotations: annotations': ['replaceAnnotations', (v) => [{ annotations: v }], ['undefined', 'empty list']],
  'replaceAnnotations: locked': ['replaceAnnotations', (v) => [{ locked: v }], ['undefined', 'empty list']],
  'replaceAnnotations: descriptions': ['replaceAnnotations', (v) => [{ descriptions: v }], OPTIONS],
  'replaceAnnotations: merged': ['replaceAnnotations', (v) => [{ merged: v }], ['undefined', 'empty list']],
  'replaceAnnotations: accepted': ['replaceAnnotations', (v) => [{ accepted: v }], ['undefined', 'empty list']],
  labels: ['labels', (v) => [v], ['zero', 'one']],
  'labels: options': ['labels', (v) => [0, v], OPTIONS],
  subscribe: ['subscribe', (v) => [v], ['function']],
};
