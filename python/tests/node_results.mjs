// Results of the npm package for the frames that a test in Python describes (test_same_as_node.py): hashes of all labels and numbers.
//
// Standard input: { pairs: [{ frames: [a, b], options }], clips: [{ frames, stream, options, named, locked, accepted, annotations }],
// points: [{ positions, derivatives, options }] }. Labels of annotations are paths of files. A frame is a path of an image, or of RGBA bytes with
// their size.

import { createHash } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { json } from 'node:stream/consumers';
import { fitMotions, openClip, segmentPair, segmentStream } from 'veronese';
import { decodeImage } from 'veronese/codecs';

async function pixels(frame) {
  const bytes = new Uint8Array(await readFile(frame.path));
  return frame.width === undefined ? decodeImage(bytes) : { data: bytes, width: frame.width, height: frame.height };
}

const hash = (bytes) => createHash('sha256').update(bytes).digest('hex');

/** All numbers in the order of the test. */
const numbers = (list) => hash(new Uint8Array(Float64Array.from(list.flat(Infinity)).buffer));

const matrix = (entries) => (entries ? [1, ...entries] : [0]);

/** The names of what objects of each class of Python hold here. */
const entries = {};

function see(name, [object]) {
  if (object) entries[name] = Object.keys(object);
}

function ofPair({ labels, motions, junctions, evidence, confidence }) {
  see('SegmentedMotion', motions);
  see('Junction', junctions);
  see('Candidate', evidence.candidates);
  return {
    labels: hash(labels),
    confidence: confidence ? hash(confidence) : null,
    numbers: numbers([
      motions.map(({ label, matrix, pixels, share, residual, bbox, group }) => [label, matrix, pixels, share, residual, bbox, group]),
      junctions.map(({ labels, likelihood, border }) => [labels, likelihood, border]),
      evidence.candidates.map(({ motions, score }) => [motions, score]),
    ]),
  };
}

/** The form of an annotation is the name of its file of labels, if it has one. */
async function annotationOf(given) {
  const form = ['strokes', 'mask', 'labels'].find((name) => given[name]);
  return form ? { ...given, [form]: new Uint8Array(await readFile(given[form])) } : given;
}

async function segmented({
  frames,
  stream,
  options: { markUnknown, ...options },
  named = [],
  locked = [],
  accepted = [],
  annotations = [],
}) {
  if (stream) {
    const found = segmentStream(frames.map(pixels), { markUnknown, ...options });
    const labels = [];
    for await (const frame of found) labels.push(hash(frame.labels));
    return { labels, tracks: found.tracks(), changes: [] };
  }
  const clip = await openClip({ length: frames.length, read: (index) => pixels(frames[index]) }, { markUnknown });
  await clip.segment(options);
  for (const number of named) await clip.describe(number, { name: 'thing' });
  await clip.lock(locked);
  await clip.accept(accepted);
  const changes = annotations.length > 0 ? await clip.annotate(...(await Promise.all(annotations.map(annotationOf)))) : [];
  const labels = [];
  for (const index of frames.keys()) labels.push(hash((await clip.labels(index)).labels));
  const tracks = await clip.tracks();
  await clip.close();
  return { labels, tracks, changes };
}

async function ofClip(given) {
  const { labels, tracks, changes } = await segmented(given);
  const { objects, background, dropped } = tracks;
  see(
    'Sighting',
    objects.flatMap((object) => object.frames),
  );
  see('BackgroundMotion', background);
  const seen = ({ frame, pixels, bbox, confidence, matrix: entries }) => [frame, pixels, bbox, confidence, matrix(entries)];
  return {
    labels,
    tracks: numbers([
      objects.map(({ id, first, last, frames }) => [id, first, last, frames.map(seen)]),
      background.map(({ frame, matrix }) => [frame, matrix]),
      dropped,
    ]),
    changes: changes.map(({ frame, object, gained, lost }) => [frame, object, gained, lost]),
  };
}

async function ofPoints({ positions, derivatives, options }) {
  const { labels, motions, evidence, stages } = await fitMotions(
    { positions: Float64Array.from(positions), derivatives: Float64Array.from(derivatives) },
    options,
  );
  see('FittedMotion', motions);
  see('PaperStages', stages ? [stages] : []);
  see('Refinement', stages ? [stages.refinement] : []);
  see('RankCandidate', stages?.ranks ?? []);
  return {
    labels: hash(labels),
    numbers: numbers([motions.map(({ matrix, measurements, determined }) => [matrix, measurements, determined]), evidence.singularValues]),
  };
}

const asked = await json(process.stdin);
const results = { pairs: [], clips: [], points: [] };
for (const { frames, options } of asked.pairs)
  results.pairs.push(ofPair(await segmentPair(await pixels(frames[0]), await pixels(frames[1]), options)));
for (const clip of asked.clips) results.clips.push(await ofClip(clip));
for (const points of asked.points) results.points.push(await ofPoints(points));
process.stdout.write(JSON.stringify({ ...results, entries }));
