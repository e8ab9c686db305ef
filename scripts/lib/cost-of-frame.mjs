// node cost-of-frame.mjs FOLDER QUALITY: what a frame of this clip costs in one worker, as JSON. Seconds are of the processor.

import { readFile, readdir } from 'node:fs/promises';
import { join } from 'node:path';

import { decodeImage, encodePng } from '../../pkg/dist/codecs.js';
import { Segmenter, davisPalette } from '../../pkg/dist/node.js';

const [folder, quality] = process.argv.slice(2);
const files = await Promise.all((await readdir(folder)).toSorted().map((name) => readFile(join(folder, name))));
const seconds = () => {
  const { user, system } = process.cpuUsage();
  return (user + system) / 1e6;
};

await decodeImage(files[0]);
const decoding = seconds();
const frames = [];
for (const file of files) frames.push(await decodeImage(file));
const n = frames.length;
const decode = (seconds() - decoding) / n;
const size = frames[0];

const segmenter = new Segmenter();
const resident = process.memoryUsage().rss;
const run = async (options, length = n) => {
  const since = seconds();
  const clip = segmenter.segmentClip({ length, read: (k) => frames[k] }, { quality, ...options });
  const { value } = await clip.next();
  const tracked = seconds() - since;
  const all = [value];
  for await (const frame of clip) all.push(frame);
  return { tracked, labelled: seconds() - since - tracked, all, state: await clip.state() };
};
// A module is slow until it is compiled.
const few = 6;
await run({}, few);

const told = [];
const whole = await run({ onPairs: (k, bytes) => (told[k] = bytes) });
const known = await run({ knownPairs: (k) => told[k] });
segmenter.close();
const encoding = seconds();
let png = 0;
for (const { labels } of whole.all) png += (await encodePng(size.width, size.height, labels, { palette: davisPalette() })).length;
const encode = (seconds() - encoding) / n;

const [pair, track] = [(whole.tracked - known.tracked) / (n - 1), known.tracked / n];
const bytesOf = (list) => Math.round(list.reduce((sum, { length }) => sum + length, 0) / list.length);
const figures = {
  pair,
  track,
  label: known.labelled / (n - 1),
  decode,
  encode,
  file: bytesOf(files),
  pairs: bytesOf(told.slice(1)),
  state: Math.round(known.state.length / n),
  png: Math.round(png / n),
  memory: process.resourceUsage().maxRSS * 1024 - resident,
};
process.stdout.write(JSON.stringify(figures, (_, value) => (typeof value === 'number' && value < 100 ? Number(value.toPrecision(3)) : value)));
