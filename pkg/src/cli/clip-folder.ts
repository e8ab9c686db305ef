// The folder of a clip: labels/NAME.png for each frame, and tracks.json, which is written last.

import { join } from 'node:path';
import type { AnnotationNote, FormatMotion, Metadata } from '../../types/formats.js';
import type { ClipChange, ClipTracks, Matrix } from '../../types/index.js';
import { FRAME_RATES, isFrameRate, isListOf, isObject, isRising, isWhole, keyOf, LONGEST_SIDE, UNLABELLED } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { readJson, readLabels } from './label-files.js';
import { CLASS, isFileName, lastOf, type Range, type Sequence, type SequenceFrame, sequenceName } from './sequence.js';

export const TRACKS = 'tracks.json';
export const LABELS = 'labels';
/** For another run to use again. Nothing is lost but time where it is missing. */
export const HIDDEN = '.clip';

/** Latest time of a frame, seconds. */
const LATEST = 1e9;

/** The content of tracks.json. */
export interface ClipManifest extends Omit<ClipTracks, 'notes'> {
  version: 1;
  width: number;
  height: number;
  /** Of a video: frames per second on average, and the time of each frame in seconds from the first. */
  frameRate?: number;
  timestamps?: number[];
  /** Names of the frames' images. */
  frames: string[];
  /** Names of the frames' own files. */
  files: string[];
  /** The changes by corrections, where there are any. */
  changes?: readonly ClipChange[];
  /** What was assumed, where something was. */
  notes?: readonly AnnotationNote[];
  settings: { overlay: boolean; show?: readonly string[]; [name: string]: unknown };
  /** Hash of the settings and the frames. */
  job: string;
}

/** The part of tracks.json that is read. */
type Tracks = Pick<ClipManifest, 'width' | 'height' | 'frames' | 'files' | 'objects' | 'background' | 'frameRate' | 'timestamps'>;
/** An object in a frame. */
type Sighting = Tracks['objects'][number]['frames'][number];

/** Reads tracks.json at once, each frame when it is asked for. `frameRate` goes before that of tracks.json. */
export async function openClip(folder: string, range: Range, background: boolean, frameRate?: number): Promise<Sequence> {
  const path = join(folder, TRACKS);
  const tracks = tracksOf(await readJson(path), path);
  const until = lastOf(range, tracks.frames.length - 1);
  const within = ({ frame }: Sighting) => frame >= range.from && frame <= until;
  const objects = tracks.objects.filter(({ frames }) => frames.some(within));
  const names = Object.fromEntries(objects.map(({ id, name }) => [id, name ?? CLASS.object]));
  return {
    meta: {
      clip: sequenceName(folder),
      names: { 0: CLASS.background, ...names },
      labels: [...(background ? [0] : []), ...objects.map(({ id }) => id)],
      tracked: true,
      ...(frameRate === undefined ? timesOf(tracks, range.from, until) : { frameRate }),
    },
    count: until + 1 - range.from,
    async *[Symbol.asyncIterator]() {
      const [known, still] = [sightings(tracks), new Map(tracks.background.map(({ frame, matrix }) => [frame, matrix]))];
      for (let frame = range.from; frame <= until; frame++) {
        yield await readFrame(folder, tracks, frame, known[frame] ?? new Map(), still.get(frame));
      }
    },
  };
}

function timesOf({ frameRate, timestamps }: Tracks, from: number, until: number): Pick<Metadata, 'frameRate' | 'timestamps'> {
  const times = timestamps?.slice(from, until + 1).map((time) => time - (timestamps[from] as number));
  return { ...(frameRate !== undefined && { frameRate }), ...(times && { timestamps: times }) };
}

/** By frame, the objects that are there, by number. */
function sightings({ frames, objects }: Tracks): Map<number, Sighting>[] {
  const known: Map<number, Sighting>[] = frames.map(() => new Map());
  for (const { id, frames } of objects) for (const sighting of frames) known[sighting.frame]?.set(id, sighting);
  return known;
}

async function readFrame(
  folder: string,
  tracks: Tracks,
  frame: number,
  known: ReadonlyMap<number, Sighting>,
  background: Matrix | null | undefined,
): Promise<SequenceFrame> {
  const stem = tracks.frames[frame] as string;
  const path = join(folder, LABELS, `${stem}.png`);
  const { labels, width, height } = await readLabels(path);
  if (width !== tracks.width || height !== tracks.height) {
    const sizes = `${width}×${height}, not ${tracks.width}×${tracks.height}`;
    throw new VeroneseError('frame-size-mismatch', `'${path}' differs in size from what '${TRACKS}' says: ${sizes} pixels`);
  }
  checkPixels(labels, known, path);
  const motions: FormatMotion[] = background ? [{ label: 0, matrix: background }] : [];
  for (const [label, { matrix }] of known) if (matrix) motions.push({ label, matrix });
  return { labels, width, height, image: tracks.files[frame] as string, motions };
}

/** Throws unless the objects are those of tracks.json, with as many pixels. */
function checkPixels(labels: Uint8Array, known: ReadonlyMap<number, Sighting>, path: string): void {
  const counts = new Uint32Array(UNLABELLED + 1);
  for (const label of labels) counts[label] = (counts[label] as number) + 1;
  for (let label = 1; label < UNLABELLED; label++) {
    const [found, listed] = [counts[label], known.get(label)?.pixels ?? 0];
    if (found === listed) continue;
    const sentence = `object ${label} has ${found} pixels in '${path}' and ${listed} by '${TRACKS}': they are not of the same result`;
    throw new VeroneseError('invalid-input', sentence);
  }
}

export function tracksOf(value: unknown, path: string): Tracks {
  const wrong = (what: string) => new VeroneseError('invalid-input', `'${path}' is not of 'veronese clip': ${what}`);
  if (!isObject(value)) throw wrong('it is no object');
  const { width, height, frames, objects, background = [], frameRate, timestamps } = value;
  if (value['version'] !== 1) throw wrong('its version is not 1');
  if (!isWhole(width, 1, LONGEST_SIDE) || !isWhole(height, 1, LONGEST_SIDE))
    throw wrong(`"width" and "height" must be from 1 to ${LONGEST_SIDE}`);
  if (!isListOf(frames, isFileName) || frames.length === 0) throw wrong('"frames" must be names of files');
  if (new Set(frames.map(keyOf)).size < frames.length) throw wrong('"frames" has a name twice');
  const { files: named = [] } = value;
  if (!isListOf(named, isFileName) || ![0, frames.length].includes(named.length)) throw wrong('"files" must have a name for each frame');
  // Frames of a video are no files: they are called what their labels are.
  const areFiles = new Set(named.map(keyOf)).size === frames.length && !named.some((name) => /#\d+$/.test(name));
  const files = areFiles ? named : frames.map((name) => `${name}.png`);
  const isFrame = (frame: unknown): frame is number => isWhole(frame, 0, frames.length - 1);
  const isMatrix = (matrix: unknown): matrix is Matrix | null =>
    matrix === null || (Array.isArray(matrix) && matrix.length === 6 && matrix.every(Number.isFinite));
  const isSighting = (entry: unknown): entry is Sighting =>
    isObject(entry) && isFrame(entry['frame']) && isWhole(entry['pixels'], 1, width * height) && isMatrix(entry['matrix'] ?? null);
  const isName = (name: unknown) => name === undefined || typeof name === 'string';
  const isObjectOfClip = (entry: unknown): entry is Tracks['objects'][number] =>
    isObject(entry) && isWhole(entry['id'], 1, UNLABELLED - 1) && isName(entry['name']) && isListOf(entry['frames'], isSighting);
  if (!isListOf(objects, isObjectOfClip)) {
    throw wrong(`"objects" must have an id from 1 to ${UNLABELLED - 1}, and "frames" with their numbers, pixels and matrices`);
  }
  if (new Set(objects.map(({ id }) => id)).size < objects.length) throw wrong('"objects" has an id twice');
  const isStill = (entry: unknown): entry is Tracks['background'][number] =>
    isObject(entry) && isFrame(entry['frame']) && isMatrix(entry['matrix'] ?? null);
  if (!isListOf(background, isStill)) throw wrong('"background" must have frames and matrices');
  for (const seen of [background, ...objects.map(({ frames }) => frames)]) {
    if (new Set(seen.map(({ frame }) => frame)).size < seen.length) throw wrong('an object is in one frame twice');
  }
  if (frameRate !== undefined && !isFrameRate(frameRate)) {
    throw wrong(`"frameRate" must be a number from ${FRAME_RATES.least} to ${FRAME_RATES.most}`);
  }
  const isTimes = (times: unknown): times is number[] =>
    isRising(times) && times.length === frames.length && (times[0] as number) >= 0 && (times.at(-1) as number) <= LATEST;
  if (timestamps !== undefined && !isTimes(timestamps)) {
    throw wrong('"timestamps" must have a number from 0 for each frame, none below the one before it');
  }
  const times = { ...(frameRate !== undefined && { frameRate }), ...(timestamps && { timestamps }) };
  return { width, height, frames, files, objects: [...objects].sort((a, b) => a.id - b.id), background, ...times };
}
