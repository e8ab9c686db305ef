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
const run = async (pairs, count = n) => {
  const since = seconds();
  const clip = await segmenter.openClip(frames.slice(0, count));
  // The labels of a frame are drawn when they are asked for.
  await clip.segment({ quality, pairs });
  const tracked = seconds() - since;
  const all = [];
  for (let index = 0; index < count; index++) all.push(await clip.labels(index));
  const labelled = seconds() - since - tracked;
  const saved = await clip.save();
  await clip.close();
  return { tracked, labelled, all, saved };
};
// A module is slow until it is compiled.
const few = 6;
await run(undefined, few);

const solving = seconds();
const solved = [];
for (let k = 1; k < n; k++) solved[k] = await segmenter.solvePair(frames[k - 1], frames[k], { quality });
const pair = (seconds() - solving) / (n - 1);
const known = await run((k) => solved[k]);
segmenter.close();
const encoding = seconds();
let png = 0;
for (const { labels } of known.all) png += (await encodePng(size.width, size.height, labels, { palette: davisPalette() })).length;
const encode = (seconds() - encoding) / n;

const bytesOf = (list) => Math.round(list.reduce((sum, { length }) => sum + length, 0) / list.length);
const figures = {
  pair,
  track: known.tracked / n,
  label: known.labelled / n,
  decode,
  encode,
  file: bytesOf(files),
  pairs: bytesOf(solved.slice(1)),
  saved: Math.round(known.saved.length / n),
  png: Math.round(png / n),
  memory: process.resourceUsage().maxRSS * 1024 - resident,
};
process.stdout.write(
  JSON.stringify(figures, (_, value) => (typeof value === 'number' && value < 100 ? Number(value.toPrecision(3)) : value)),
);
