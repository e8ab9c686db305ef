// Every reader of annotations on files that are cut or whose values are exchanged: the masks, or an error with a code that names the file;
// nothing else, and soon.

import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { encode, readAnnotations } from 'veronese/formats';
import { random } from '../../scripts/lib/random.mjs';
import { document } from './support/encoded.mjs';
import { drawn } from './support/masks.mjs';
import { stopwatch } from './support/processor.mjs';
import { soaking } from './support/soak.mjs';

const [width, height] = [5, 5];
const { labels } = drawn('00000', '01120', '01020', '01120', '30000');
const metadata = { names: { 1: 'car', 2: 'car', 3: 'dog' }, labels: [1, 2, 3] };
const one = { labels, width, height, image: 'f0.png' };
const frames = [0, 1, 2].map((k) => ({ labels: labels.map((label) => (label === k ? 0 : label)), width, height, image: `f${k}.png` }));

const DOCUMENTS = {};
for (const format of ['coco', 'coco-polygon', 'label-studio', 'label-studio-polygon']) DOCUMENTS[format] = await document(format, one, metadata);
DOCUMENTS['youtube-vis'] = await document('youtube-vis', frames, metadata);
const FILES = Object.fromEntries(Object.entries(DOCUMENTS).map(([format, value]) => [format, JSON.stringify(value)]));
for (const format of ['cvat', 'cvat-polygon', 'davis']) [{ content: FILES[format] }] = await encode(format, one, metadata);
for (const format of ['cvat-video', 'mots']) [{ content: FILES[format] }] = await encode(format, frames, metadata);
FILES['cvat-boxes'] = await document('cvat-video', frames, { ...metadata, shape: 'box' });
FILES.yolo = `${await document('yolo', one, metadata)}1 0.5 0.5 0.25 0.5\n`;
const CODES = ['invalid-input', 'unreadable-image', 'frame-size-mismatch'];
const JUNK = [null, -1, 0, 0.5, 1e9, 2 ** 53, 'x', '', '..', [], {}, [null], true, [[1, 2, 3]], { size: [4, 4] }];
/** Seconds: far more than any of these files takes on a machine that does other things too. */
const LONG = 10;

const bytesOf = (content) => (typeof content === 'string' ? new TextEncoder().encode(content) : Uint8Array.from(content));

/** Reads a file to its last mask; whatever goes wrong is an error of ours that names the file. */
function outcome(content, what) {
  const seconds = stopwatch();
  try {
    const { frames, boxes, notes } = readAnnotations([{ name: 'folder/the.file', bytes: bytesOf(content) }], { size: { width, height } });
    for (const frame of frames.values()) assert.equal(frame.read().length, frame.width * frame.height, what);
    for (const { message } of notes) assert.match(message, /the\.file/);
    assert.ok(frames.size + boxes.length > 0 || notes.length > 0, `${what}: nothing, and no word`);
  } catch (error) {
    assert.equal(error.name, 'VeroneseError', `${what}: ${error.stack}`);
    assert.ok(CODES.includes(error.code), `${what}: ${error.code}`);
    assert.match(error.message, /the\.file/, what);
    assert.ok(error.message.length < 500, what);
  }
  assert.ok(seconds() < LONG, what);
}

/** A copy of a document in which one value is another. */
function exchanged(document, next) {
  const copy = structuredClone(document);
  const places = [];
  const visit = (value) => {
    if (typeof value !== 'object' || value === null) return;
    for (const key of Object.keys(value)) {
      places.push([value, key]);
      visit(value[key]);
    }
  };
  visit(copy);
  const [parent, key] = places[Math.floor(next() * places.length)];
  const other = places[Math.floor(next() * places.length)];
  parent[key] = next() < 0.3 ? structuredClone(other[0][other[1]]) : JUNK[Math.floor(next() * JUNK.length)];
  return copy;
}

const times = soaking ? 2000 : 120;

describe('files that are cut', () => {
  for (const [name, content] of Object.entries(FILES)) {
    test(name, () => {
      const bytes = bytesOf(content);
      const step = soaking ? 1 : Math.max(1, Math.floor(bytes.length / times));
      for (let length = 0; length < bytes.length; length += step) outcome(bytes.subarray(0, length), `${name}, ${length} bytes`);
      outcome(bytes, name);
    });
  }
});

describe('files with other values', () => {
  for (const [name, document] of Object.entries(DOCUMENTS)) {
    test(name, () => {
      const next = random(11);
      for (let round = 0; round < times; round++) {
        const changed = JSON.stringify(exchanged(document, next));
        outcome(changed, changed.slice(0, 2000));
      }
    });
  }
  for (const [name, content] of Object.entries(FILES).filter(([name]) => !(name in DOCUMENTS))) {
    test(name, () => {
      const next = random(12);
      for (let round = 0; round < times; round++) {
        const bytes = bytesOf(content);
        for (let change = 0; change < 3; change++) bytes[Math.floor(next() * bytes.length)] = typeof content === 'string' ? 32 + Math.floor(next() * 90) : Math.floor(next() * 256);
        outcome(bytes, `${name}, round ${round}`);
      }
    });
  }
});
