// `clip`: writes the labels of each frame, prints a line of JSON for each, and writes the tracks at the end.

import { join } from 'node:path';
import type { ClipAnnotation, ClipChange, ClipFrame, ClipTracks, Note, Segmenter } from '../../types/index.js';
import { version } from '../calls/version.js';
import { UNLABELLED } from '../common/checks.js';
import { davisPalette } from '../common/palette.js';
import { encodePng } from '../entries/codecs.js';
import { SegmenterPool } from '../entries/node.js';
import { USUAL_RATE } from '../formats/metadata.js';
import type { ClipCommand } from './arguments.js';
import { readCorrections, type Corrections } from './clip-corrections.js';
import { type ClipManifest, LABELS } from './clip-folder.js';
import { type ClipFrames, clipFrames } from './clip-frames.js';
import { clearKept, type KeptClip, keptClip } from './clip-kept.js';
import { clipStore } from './clip-store.js';
import type { Io } from './io.js';
import { readLabels } from './label-files.js';
import { Output } from './output.js';
import { overlay } from './overlay.js';
import { jsonLine } from './pair.js';
import { checkFilms, type Showing, shownOn } from './showing.js';
import { note, print, progressBar, warn } from './terminal.js';
import { oneForEach } from './threads.js';

const segmenters = oneForEach((jobs) => new SegmenterPool({ jobs }));

/** Frames as they are labelled, and what is known after them. */
interface Labelled {
  frames: AsyncIterable<ClipFrame>;
  tracks: () => ClipTracks | Promise<ClipTracks>;
  changes: readonly ClipChange[];
  notes: Note[];
}

/** If a frame is bad, writes the labels of the frames before it and throws. */
export async function clip(command: ClipCommand, io: Io): Promise<void> {
  const { out, options, every, overlay: wanted, show, maxSize, force } = command;
  const { motions, quality, subject, markUnknown } = options;
  await checkFilms(show);
  const output = new Output(out, { force, signal: io.signal });
  const frames = await clipFrames(command, io);
  const segmenter = segmenters(command.jobs);
  const progress = passes(frames.length, io);
  const rate = command.frameRate ?? frames.times.frameRate;
  const showing = shownOn(show, { folder: () => output.begin(), count: frames.length, rate: rate ?? USUAL_RATE });
  let kept: KeptClip | undefined;
  try {
    const corrections = await readCorrections(command, frames);
    for (const each of corrections?.notes ?? []) note(io, each);
    const software = `veronese ${version}`;
    const shown = show.length > 0 && { show: show.map(({ name }) => name), frameRate: command.frameRate };
    const settings = { ...options, every, maxSize, ...corrections?.hashes, overlay: wanted, ...shown, software };
    const store = clipStore(output, frames.files, settings);
    const { finished: before, missing } = store;
    if (before && missing.length === 0) return await report(before, io);
    store.check([...frames.paths, ...(corrections?.paths ?? [])]);

    const masks = { motions, quality, subject };
    if (options.lookAhead !== 'all') await clearKept(output);
    else kept = await keptClip(segmenter, output, frames, { ...masks, maxSize, range: frames.range, software }, markUnknown);
    const write = async (frame: ClipFrame) => {
      const { stem } = frames.files[frame.index] as { stem: string };
      await store.write(stem, await images(frames, frame, wanted, show.length > 0 ? showing : undefined));
      progress.clear();
      return stem;
    };
    if (kept && before && show.length === 0 && kept.changes(corrections?.hashes)) {
      for await (const frame of labelled(kept, missing, progress)) await write(frame);
      return await report(before, io);
    }
    let segmented: Labelled;
    if (kept) {
      kept.clip.subscribe((event) => event.type === 'progress' && progress.update(event));
      if (!kept.clip.frames.every(({ hasMasks }) => hasMasks))
        await kept.clip.segment(masks).then(undefined, (thrown: unknown) => {
          // The frames before a bad one have masks.
          if (!frames.failure) throw thrown;
        });
      segmented = await annotated(kept, frames, corrections, store.isSeen ? out : undefined, progress);
    } else segmented = streamed(segmenter, frames, options, progress);
    await store.begin();
    for await (const frame of segmented.frames) {
      const name = await write(frame);
      await print(io, jsonLine({ frame: frame.index, name, objects: frame.objects.map(({ id }) => id) }));
    }
    if (frames.failure) throw frames.failure.thrown;
    const films = await showing.end();
    await store.show(films);
    const { notes: reasons = [], ...tracks } = await segmented.tracks();
    if (films.films.length > 0 && rate === undefined) frames.notes.push(rateNote(command));
    const found = [...frames.notes, ...segmented.notes];
    // Of one motion that was asked for, and of what a person has corrected, there is nothing to say.
    for (const { step, ...rest } of corrections || motions === 1 ? [] : reasons)
      found.push(step ? { ...rest, message: `${rest.message}: try '--every ${step * every}'`, step } : rest);
    const { changes } = segmented;
    const size = frames.size as { width: number; height: number };
    await store.end({ ...size, ...frames.times }, tracks, changes, [...(corrections?.notes ?? []), ...found]);
    for (const each of found) note(io, each);
    for (const { name, kind, object } of show) {
      const isThere = kind !== 'cutout' || object === 0 || tracks.objects.some(({ id }) => id === object);
      if (!isThere) warn(io, `there is no object ${object}: '${name}' is transparent`);
    }
    if (tracks.dropped > 0)
      warn(io, `${tracks.dropped} more objects were seen when all 254 numbers had been given; they count as background`);
    await print(io, lastLine(tracks.objects, changes));
  } catch (thrown) {
    segmenter.close();
    throw thrown;
  } finally {
    await kept?.clip.close();
    showing.close();
    output.discard();
    progress.clear();
    await frames.close();
  }
}

/** The clip with its annotations. `before`: the folder with the results of a finished run on these frames, if there is one. */
async function annotated(
  kept: KeptClip,
  frames: ClipFrames,
  corrections: Corrections | undefined,
  before: string | undefined,
  progress: Progress,
): Promise<Labelled> {
  const { clip } = kept;
  const indices = clip.frames.flatMap(({ hasMasks }, index) => (hasMasks ? [index] : []));
  let changes = indices.length > 0 ? kept.changes(corrections?.hashes) : [];
  if (!changes) {
    const { annotations = [], accepted = [], ...edits } = corrections?.declaration ?? {};
    const stays = accepted.filter((frame) => indices.includes(frame));
    if (before !== undefined) await acceptAsSeen(kept, frames, stays, before);
    const of = annotations.filter(({ frame }) => indices.includes(frame));
    changes = await clip.replaceAnnotations({ ...edits, annotations: of, accepted: stays });
    await kept.annotated(corrections?.hashes, changes);
  }
  const objects = clip.objects.map(({ number }) => number);
  const missing = corrections?.edited.filter((object) => !objects.includes(object)) ?? [];
  const there = objects.length > 0 ? `the objects are ${objects.join(', ')}` : 'there is no object';
  const message = `edits of objects that are not there change nothing: ${missing.join(', ')}; ${there}`;
  const notes = missing.length > 0 ? [{ code: 'object-missing', message }] : [];
  return { frames: labelled(kept, indices, progress), tracks: () => clip.tracks(), changes, notes };
}

/** Accepts frames with the labels that a person saw. If this run is interrupted, the next one finds them accepted. */
async function acceptAsSeen({ clip }: KeptClip, { files }: ClipFrames, accepted: readonly number[], folder: string): Promise<void> {
  const fresh = accepted.filter((frame) => !clip.frames[frame]?.accepted);
  if (fresh.length === 0) return;
  const annotations: ClipAnnotation[] = [];
  for (const frame of fresh) {
    const { labels } = await readLabels(join(folder, LABELS, `${files[frame]?.stem}.png`));
    // A map is about the objects that it names; an eraser about all.
    for (const map of [labels, labels.map((label) => (label === 0 ? 0 : UNLABELLED))])
      annotations.push({ frame, labels: map, propagate: 'none' });
  }
  await clip.replaceAnnotations({ annotations, accepted: accepted.filter((frame) => !fresh.includes(frame)) });
  await clip.accept(fresh);
}

/** The labels of frames, in order: the next frame is labelled while one is looked at. */
async function* labelled({ clip }: KeptClip, indices: readonly number[], progress: Progress): AsyncGenerator<ClipFrame, void, undefined> {
  const ask = (at: number) => {
    const labels = indices[at] === undefined ? undefined : clip.labels(indices[at]);
    labels?.catch(() => undefined);
    return labels;
  };
  for (let at = 0, next = ask(0); next; at++) {
    progress.update({ stage: 'labels', frame: indices[at] as number });
    const frame = await next;
    next = ask(at + 1);
    yield frame;
  }
}

function streamed(
  segmenter: Segmenter,
  frames: ClipFrames,
  { lookAhead, ...options }: ClipCommand['options'],
  progress: Progress,
): Labelled {
  const source = async function* () {
    for (let index = 0; index < frames.length; index++) yield await frames.read(index);
  };
  const onProgress = ({ frame }: { frame: number }) => progress.update({ stage: 'pairs', frame });
  const stream = segmenter.segmentStream(source(), { ...options, lookAhead: Number(lookAhead), onProgress });
  return { frames: stream, tracks: () => stream.tracks(), changes: [], notes: [] };
}

type Progress = ReturnType<typeof passes>;

/** The progress bar of each pass over the frames. */
function passes(count: number, { stderr }: Io) {
  let [pass, bar] = ['', undefined as ReturnType<typeof progressBar> | undefined];
  return {
    update({ stage, frame }: { stage: string; frame: number }): void {
      // Annotations come to some frames, and to some of them more than once.
      const total = stage === 'annotations' ? undefined : count;
      if (stage !== pass) bar = progressBar(total, stderr, { unit: 'frames', title: `${stage}: ` });
      pass = stage;
      bar?.update({ done: frame, skipped: 0, failed: 0 });
    },
    clear: () => bar?.clear(),
  };
}

/** The pictures of a frame by their folders. */
async function images(
  frames: ClipFrames,
  frame: ClipFrame,
  withOverlay: boolean,
  showing: Showing | undefined,
): Promise<{ [folder: string]: Uint8Array }> {
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
async function report({ frames, objects, changes = [], notes = [] }: ClipManifest, io: Io): Promise<void> {
  // Masks may be the same ones in other files by now: what is true of those was said before.
  for (const each of notes) if (!each.code.startsWith('mask-')) note(io, each);
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
