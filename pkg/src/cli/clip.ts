// `clip`: writes the labels of each frame, prints a line of JSON for each, and writes the tracks at the end.

import { join } from 'node:path';
import type { Clip, ClipChange, ClipFrame, ClipProgress, Note, Segmenter as SegmenterType } from '../../types/index.js';
import { version } from '../calls/version.js';
import { UNLABELLED } from '../common/checks.js';
import { davisPalette } from '../common/palette.js';
import { encodePng } from '../entries/codecs.js';
import { SegmenterPool } from '../entries/node.js';
import { USUAL_RATE } from '../formats/metadata.js';
import type { ClipCommand } from './arguments.js';
import { readCorrections, type Corrections } from './clip-corrections.js';
import { LABELS } from './clip-folder.js';
import { type ClipFrames, clipFrames } from './clip-frames.js';
import { KeptClip } from './clip-kept.js';
import { type ClipManifest, ClipStore } from './clip-store.js';
import type { Io } from './io.js';
import { readLabels } from './label-files.js';
import { Output } from './output.js';
import { overlay } from './overlay.js';
import { jsonLine } from './pair.js';
import { checkFilms, Showing } from './showing.js';
import { note, print, ProgressBar, warn } from './terminal.js';
import { oneForEach } from './threads.js';

const segmenters = oneForEach((jobs) => new SegmenterPool({ jobs }));

/** If a frame is bad, writes the labels of the frames before it and throws. */
export async function clip(command: ClipCommand, io: Io): Promise<void> {
  const { out, options, every, overlay: wanted, show, maxSize, force } = command;
  await checkFilms(show);
  const output = new Output(out, { force, signal: io.signal });
  const frames = await clipFrames(command, io);
  const segmenter = segmenters(command.jobs);
  const progress = new Passes(frames.length, io);
  const rate = command.frameRate ?? frames.times.frameRate;
  const showing = new Showing(show, { folder: () => output.begin(), count: frames.length, rate: rate ?? USUAL_RATE });
  try {
    const corrections = await readCorrections(command, frames);
    for (const each of corrections?.notes ?? []) note(io, each);
    const software = `veronese ${version}`;
    const store = new ClipStore(output, { ...options, every, maxSize, ...corrections?.hashes, overlay: wanted, ...(show.length > 0 && { show: show.map(({ name }) => name), frameRate: command.frameRate }), software });
    const before = store.finished(frames.files);
    if (before) {
      // Masks may be the same ones in other files by now: of those the note above is right.
      for (const each of before.notes ?? []) if (!each.code.startsWith('mask-')) note(io, each);
      return await report(before, io);
    }
    store.check(frames.files, [...frames.paths, ...(corrections?.paths ?? [])]);

    const kept = new KeptClip(output, { ...options, markUnknown: undefined, maxSize, software, range: frames.range }, frames.files);
    const accepted = await acceptedAsSeen(out, corrections, frames, { store, kept });
    // If this run is interrupted, the next one has them.
    await kept.keepAccepted(accepted);
    await store.begin();
    const streams = options.lookAhead !== 'all' && !corrections;
    const onProgress = progress.listener;
    const segmented = streams
      ? segmenter.segmentClip(frames, { ...options, onProgress })
      : await corrected(segmenter, frames, command, corrections && { ...corrections, seen: accepted }, kept, onProgress);
    for await (const frame of segmented) {
      const { stem } = frames.files[frame.index] as { stem: string };
      await store.write(stem, await images(frames, frame, wanted, show.length > 0 ? showing : undefined));
      progress.clear();
      await print(io, jsonLine({ frame: frame.index, name: stem, objects: frame.objects.map(({ id }) => id) }));
    }
    if (frames.failure) throw frames.failure.thrown;
    const { films, sheet } = await showing.end();
    if (films.length > 0 || sheet) await store.show(films, sheet);
    const { notes = [], ...tracks } = segmented.tracks();
    if (streams) await kept.clear();
    const changes = await segmented.changes();
    if (films.length > 0 && rate === undefined) frames.notes.push(rateNote(command));
    const found = [...frames.notes, ...notes.map(({ step, ...rest }) => (step ? { ...rest, message: `${rest.message}: try '--every ${step * every}'`, step } : rest))];
    await store.end(frames.files, { ...(frames.size as { width: number; height: number }), ...frames.times }, tracks, changes, [...(corrections?.notes ?? []), ...found]);
    for (const each of found) note(io, each);
    for (const { name, object } of show) {
      const isThere = !name.startsWith('cutout') || object === 0 || tracks.objects.some(({ id }) => id === object);
      if (!isThere) warn(io, `there is no object ${object}: '${name}' is transparent`);
    }
    if (tracks.dropped > 0) warn(io, `${tracks.dropped} more objects were seen when all 254 numbers had been given; they count as background`);
    await print(io, lastLine(tracks.objects, changes));
  } catch (thrown) {
    segmenter.close();
    throw thrown;
  } finally {
    showing.close();
    output.discard();
    progress.clear();
    await frames.close();
  }
}

/** A clip whose pairs are solved once and kept, with its corrections; of the frames up to the first bad one. */
async function corrected(
  segmenter: SegmenterType,
  frames: ClipFrames,
  { options }: ClipCommand,
  given: (Corrections & { seen: ReadonlyMap<number, Uint8Array> }) | undefined,
  kept: KeptClip,
  onProgress: (progress: ClipProgress) => void,
): Promise<Clip> {
  const state = kept.state() ?? (await solved(segmenter, frames, options, kept, onProgress));
  const length = frames.failure?.index ?? frames.length;
  const isThere = ({ frame }: { frame: number }) => frame < length;
  const [masks, corrections, prompts] = [given?.masks.filter(isThere), given?.corrections.filter(isThere), given?.prompts.filter(isThere)];
  const accepted = given?.accepted.map((frame) => ({ frame, labels: given.seen.get(frame) })).filter(isThere);
  const { markUnknown } = options;
  const all = { masks, corrections, prompts, accepted, edits: given?.edits };
  return segmenter.segmentClip({ length, read: frames.read }, { state, markUnknown, ...all, onProgress });
}

/**
 * The labels of accepted frames as the person saw them: those of the last run that was finished here, or of one that was begun after it. A
 * frame without is accepted as it is found.
 */
async function acceptedAsSeen(
  out: string,
  corrections: Corrections | undefined,
  frames: ClipFrames,
  { store, kept }: { store: ClipStore; kept: KeptClip },
): Promise<Map<number, Uint8Array>> {
  const seen = new Map<number, Uint8Array>();
  if (!corrections || corrections.accepted.length === 0) return seen;
  const before = store.before(frames.files);
  for (const frame of corrections.accepted) {
    const stem = before?.frames[frame];
    const labels = stem === undefined ? kept.accepted(frame) : (await readLabels(join(out, LABELS, `${stem}.png`))).labels;
    const mask = corrections.masks.find((mask) => mask.frame === frame);
    if (labels) seen.set(frame, mask ? labelsUnder(mask.labels, labels) : labels);
  }
  return seen;
}

/** The labels that were seen of a frame, with a mask that may have been given since: it is about the objects that it names. */
function labelsUnder(mask: Uint8Array, seen: Uint8Array): Uint8Array {
  const named = new Set(mask);
  return seen.map((label, p) => {
    const given = mask[p] as number;
    return given !== UNLABELLED && (given > 0 || named.has(label)) ? given : label;
  });
}

async function solved(
  segmenter: SegmenterType,
  frames: ClipFrames,
  options: ClipCommand['options'],
  kept: KeptClip,
  onProgress: (progress: ClipProgress) => void,
): Promise<Uint8Array | undefined> {
  const hooks = { knownPairs: (index: number) => kept.pairs(index), onPairs: (index: number, pairs: Uint8Array) => kept.keepPairs(index, pairs) };
  const solving = segmenter.segmentClip(frames, { ...options, ...hooks, onProgress });
  // All pairs are solved before the first frame comes.
  await solving.next();
  const state = await solving.state();
  await solving.return();
  if (state && !frames.failure) await kept.keepState(state);
  return state;
}

/** The progress bar of each pass over the frames. */
class Passes {
  readonly #count: number;
  readonly #io: Io;
  #stage: string | undefined;
  #bar: ProgressBar | undefined;

  constructor(count: number, io: Io) {
    this.#count = count;
    this.#io = io;
  }

  readonly listener = ({ frame, stage }: ClipProgress): void => {
    if (stage !== this.#stage) {
      // Corrections come to some frames, and to some of them more than once.
      this.#bar = new ProgressBar(stage === 'corrections' ? undefined : this.#count, this.#io.stderr, { unit: 'frames', title: `${stage}: ` });
    }
    this.#stage = stage;
    this.#bar?.update({ done: frame, skipped: 0, failed: 0 });
  };

  clear(): void {
    this.#bar?.clear();
  }
}

/** The pictures of a frame by their folders. */
async function images(frames: ClipFrames, frame: ClipFrame, withOverlay: boolean, showing: Showing | undefined): Promise<{ [folder: string]: Uint8Array }> {
  const { index, labels, width, height } = frame;
  const files = { labels: await encodePng(width, height, labels, { palette: davisPalette() }) };
  if (!withOverlay && !showing) return files;
  const picture = await frames.read(index);
  const painted = withOverlay && { overlay: await encodePng(width, height, overlay(picture.data, labels)) };
  return { ...files, ...painted, ...(await showing?.add(frame, picture)) };
}

function rateNote({ frames }: ClipCommand): Note {
  const message = `the frame rate of '${frames.join(' ')}' is not known: films have ${USUAL_RATE} frames per second; '--frame-rate' says another`;
  return { code: 'frame-rate-assumed', message };
}

/** Prints what the run that wrote the manifest printed. */
async function report({ frames, objects, changes = [] }: ClipManifest, io: Io): Promise<void> {
  for (const [frame, name] of frames.entries()) {
    const seen = objects.filter((object) => object.frames.some((entry) => entry.frame === frame));
    await print(io, jsonLine({ frame, name, objects: seen.map(({ id }) => id) }));
  }
  await print(io, lastLine(objects, changes));
}

/** With the frames that corrections have changed, and what each object has gained and lost in all of them, if they have. */
function lastLine(objects: ClipManifest['objects'], changes: readonly ClipChange[]): string {
  const done = { done: true, objects: objects.length };
  if (changes.length === 0) return jsonLine(done);
  const sums = new Map<number, { id: number; gained: number; lost: number }>();
  for (const { object: id, gained, lost } of changes) {
    const before = sums.get(id) ?? { id, gained: 0, lost: 0 };
    sums.set(id, { id, gained: before.gained + gained, lost: before.lost + lost });
  }
  const frames = [...new Set(changes.map(({ frame }) => frame))];
  return jsonLine({ ...done, changed: { frames, objects: [...sums.values()].sort((one, other) => one.id - other.id) } });
}
