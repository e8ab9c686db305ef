// Frames as files: in Node, a path or an address stands for the pixels.

import assert from 'node:assert/strict';
import { createReadStream, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { pathToFileURL } from 'node:url';
import { test } from 'node:test';
import { openClip, Segmenter, SegmenterPool, segmentPair, segmentStream } from 'veronese';
import { pair, png } from './support/frames.mjs';
import { temporaryFolder } from './support/program.mjs';
import { failure, timeless } from './support/shapes.mjs';

function files(t) {
  const folder = temporaryFolder(t);
  return { folder, paths: pair().map((frame, k) => folder.file(`${k}.png`, png(frame))) };
}

async function labelsOf(clip) {
  const all = [];
  for await (const { labels } of clip) all.push(labels);
  return all;
}

test('two frames: paths, file addresses, addresses of a server, and pixels beside them', async (t) => {
  const { paths } = files(t);
  const [first, second] = pair();
  const expected = timeless(await segmentPair(first, second));
  const server = createServer((request, response) => {
    if (request.url === '/1.png') response.end(png(second));
    else response.writeHead(404).end();
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  t.after(() => server.close());
  const address = `http://127.0.0.1:${server.address().port}`;
  const segmenter = new Segmenter();
  t.after(() => segmenter.close());
  for (const call of [segmentPair, (...given) => segmenter.segmentPair(...given)]) {
    assert.deepEqual(timeless(await call(...paths)), expected);
    assert.deepEqual(timeless(await call(pathToFileURL(paths[0]), `${address}/1.png`)), expected);
    assert.deepEqual(timeless(await call(first, new URL(`${address}/1.png`))), expected);
  }
  const missing = await failure(segmentPair(first, `${address}/2.png`));
  assert.deepEqual([missing.code, missing.message], ['file-not-found', `${address}/2.png answered 404 Not Found`]);
});

test('clips: lists of paths, streams, and frames that are read again', async (t) => {
  const { paths } = files(t);
  const expected = await labelsOf(segmentStream(pair(), { quality: 'fast' }));
  assert.deepEqual(await labelsOf(segmentStream(paths, { quality: 'fast' })), expected);
  async function* stream() {
    yield pair()[0];
    yield pathToFileURL(paths[1]);
  }
  assert.deepEqual(await labelsOf(segmentStream(stream(), { quality: 'fast' })), expected);
  const wholeOf = async (opening) => labelsOf((await opening).segment({ quality: 'fast' }));
  const whole = await wholeOf(openClip(pair()));
  assert.deepEqual(await wholeOf(openClip(paths)), whole);
  const pool = new SegmenterPool({ jobs: 2 });
  t.after(() => pool.close());
  assert.deepEqual(await wholeOf(pool.openClip({ length: 2, read: async (index) => paths[index] })), whole);
});

test('streams of bytes and files in memory, in pairs, clips and streams of frames', async (t) => {
  const { paths } = files(t);
  const expected = timeless(await segmentPair(...pair()));
  const labels = await labelsOf(segmentStream(pair(), { quality: 'fast' }));
  const stream = (k) => createReadStream(paths[k], { highWaterMark: 500 });
  const blob = (k) => new Blob([png(pair()[k])]);
  const segmenter = new Segmenter();
  t.after(() => segmenter.close());
  for (const [first, second] of [[stream(0), stream(1)], [blob(0), blob(1)], [paths[0], new File([blob(1)], '1.png')]]) assert.deepEqual(timeless(await segmentPair(first, second)), expected);
  assert.deepEqual(timeless(await segmenter.segmentPair(blob(0).stream(), paths[1])), expected);
  for (const make of [stream, blob]) {
    assert.deepEqual(await labelsOf(segmentStream([make(0), make(1)], { quality: 'fast' })), labels);
    assert.equal((await labelsOf((await openClip({ length: 2, read: make })).segment({ quality: 'fast' }))).length, 2);
  }
  async function* of(...pieces) {
    yield* pieces;
  }
  const failures = [
    [() => of('text'), 'invalid-input', /^a stream of a frame must give bytes, as Uint8Array$/],
    [() => of(), 'unreadable-image', /^the stream: the image cannot be read: it is empty$/],
    // Made when it is read: an error that comes before anyone listens ends the process.
    [() => createReadStream('nowhere.png'), 'unreadable-file', /^the stream cannot be read: ENOENT/],
    [() => new Blob(['text']), 'unreadable-image', /^the file in memory: /],
    [() => new File(['text'], 'a.png'), 'unreadable-image', /^the file 'a\.png': /],
    [() => ({ [Symbol.toStringTag]: 'Blob' }), 'invalid-input', /^the second frame must be .* in Node a path, address, Blob or stream$/],
  ];
  for (const [given, code, message] of failures) {
    const error = await failure(segmentPair(paths[0], given()));
    assert.equal(error.code, code);
    assert.match(error.message, message);
  }
});

test('where nothing reads files, the error says so', async () => {
  const { segmentPair: slim, init } = await import('veronese/slim');
  await init(readFileSync(new URL(import.meta.resolve('veronese/veronese_bg.wasm'))));
  for (const given of ['0.png', new URL('http://127.0.0.1/0.png'), new Blob([]).stream()]) {
    const error = await failure(slim(pair()[0], given));
    assert.deepEqual([error.code, error.message], ['invalid-input', "the second frame is a path, an address or a stream: only 'veronese' in Node reads these, decode it first"]);
  }
  const error = await failure(slim(pair()[0], new Blob([])));
  assert.deepEqual([error.code, error.message], ['invalid-input', 'the second frame is a picture (Blob), which nothing reads here: decode it first']);
});

test('what cannot be read is named', async (t) => {
  const { folder, paths } = files(t);
  const none = folder.path('none.png');
  const text = folder.file('text.png', 'text');
  for (const [place, code] of [[none, 'file-not-found'], [text, 'unreadable-image'], [folder.path('.'), 'unreadable-file'], [pathToFileURL(none), 'file-not-found']]) {
    const error = await failure(segmentPair(paths[0], place));
    assert.equal(error.code, code);
    assert.ok(error.message.includes(String(place)), error.message);
    assert.equal((await failure(labelsOf(segmentStream([paths[0], place])))).code, code);
  }
});
