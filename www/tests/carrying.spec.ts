//! Corrections of a clip that wait for each other, that are taken back and undone: without a browser, by changes of the state in their order.

import { SegmenterPool } from 'veronese';
import { decodeImage } from 'veronese/codecs';

import type { Clip } from '../src/clips/clip.js';
import { packed, unpacked } from '../src/correction/runs.js';
import type { DecodedFrame } from '../src/frames/frame.js';
import { Carrying } from '../src/session/clip/carrying.js';
import { ClipRuns } from '../src/session/clip/runs.js';
import { ClipSegmenting } from '../src/session/clip/segmenting.js';
import { Spans } from '../src/session/clip/spans.js';
import { PairSegmenting } from '../src/session/pair/segmenting.js';
import { PairWorker } from '../src/session/pair/worker.js';
import { Shown } from '../src/session/shown.js';
import type { Painted } from '../src/state/annotation.js';
import { Store } from '../src/state/state.js';
import { type Tracked, untracked, versionOf } from '../src/state/tracked.js';
import { clipFrames, expect, unwatched as test } from './support.js';

const [WIDTH, HEIGHT, COUNT] = [60, 42, 6];
/** The frame that is corrected. */
const AT = 2;

interface Segmented {
  readonly store: Store;
  readonly runs: ClipRuns;
  readonly carrying: Carrying;
  readonly tracked: () => Tracked;
}

/** A clip of a disc and a square that has its masks. */
async function segmented(): Promise<Segmented> {
  const pictures = await Promise.all((await clipFrames(COUNT, WIDTH, HEIGHT)).map(({ buffer }) => decodeImage(buffer)));
  const clip: Pick<Clip, 'name' | 'fingerprint' | 'count' | 'frame'> = {
    name: 'clip',
    fingerprint: 'clip',
    count: COUNT,
    // The session lets the picture go that a page would draw.
    frame: async (index) => ({ ...pictures[index]!, data: pictures[index]!.data.slice(), bitmap: { close: () => undefined } }) as unknown as DecodedFrame,
  };
  const store = new Store();
  const shown = new Shown(store, new PairSegmenting(store, new PairWorker()));
  const runs = new ClipRuns(store, new SegmenterPool({ jobs: 2 }));
  const spans = new Spans(store, runs.segmenter);
  store.set({ tracked: untracked(clip as Clip), timeline: { clip: clip as Clip, first: AT, second: AT + 1 }, settings: { ...store.get().settings, quality: 'fast' } });
  await new ClipSegmenting(store, runs, spans, shown).segment();
  const tracked = (): Tracked => store.get().tracked!;
  expect(tracked().run).toMatchObject({ phase: 'done', cause: 'found' });
  return { store, runs, carrying: new Carrying(store, runs, spans, shown), tracked };
}

/** A rectangle of 6 × 6 pixels in the corrected frame that is an object. */
function rectangle(object: number, left: number, top: number): { annotations: Painted[] } {
  const isIn = (p: number): boolean => p % WIDTH >= left && p % WIDTH < left + 6 && Math.floor(p / WIDTH) >= top && Math.floor(p / WIDTH) < top + 6;
  const labels = Uint8Array.from({ length: WIDTH * HEIGHT }, (_, p) => (isIn(p) ? object : 255));
  return { annotations: [{ frame: AT, object, propagate: 'both', labels: packed(labels, WIDTH, HEIGHT) }] };
}

/** A new object over the disc, and another one beside it. */
const [OVER, BESIDE] = [rectangle(3, 17, 14), rectangle(4, 34, 4)];
/** How many pixels each of the two has in a frame. */
const sizes = ({ frames }: Tracked, index = AT): number[] => [3, 4].map((id) => unpacked(frames[index]!.runs).filter((label) => label === id).length);

/** Acts when the correction that is made next has come through its first frame. Gives the sizes before that and after it. */
function atFirstFrame({ store, tracked }: Segmented, act: () => void): number[][] {
  const seen: number[][] = [];
  const leave = store.subscribe(({ tracked: now }) => {
    if (now?.run.phase !== 'working' || now.run.labelled === 0) return;
    leave();
    queueMicrotask(() => {
      seen.push(sizes(tracked()));
      act();
      seen.push(sizes(tracked()));
    });
  });
  return seen;
}

test('frames are shown as a correction changes them, the corrected one first, with its progress', async () => {
  const clip = await segmented();
  const { store, carrying, tracked } = clip;
  const before = tracked().frames;
  const [seen, told]: [number[][], number[]] = [[], []];
  store.subscribe(({ tracked: now }, was) => {
    if (now !== null && now.frames !== was.tracked!.frames) seen.push([...before.keys()].filter((index) => now.frames[index] !== before[index]));
    if (now?.run.phase === 'working' && now.run !== was.tracked!.run) told.push(now.run.labelled);
  });
  await carrying.correct(OVER);
  expect(tracked().run).toMatchObject({ phase: 'done', cause: 'corrected', changed: COUNT, kept: 0 });
  expect(seen[0]).toEqual([AT]);
  expect(seen.slice(1, -1).some((changed) => changed.length > 1 && changed.length < COUNT)).toBe(true);
  expect(seen.at(-1)).toEqual([...before.keys()]);
  expect(told).toEqual(told.toSorted((one, other) => one - other));
  expect([told[0], told.at(-1)]).toEqual([0, COUNT]);
  for (const index of before.keys()) expect(sizes(tracked(), index)[0]).toBeGreaterThan(0);
});

test('a correction that is taken back leaves nothing, and one that waits for it is carried on; undo takes back the last', async () => {
  const clip = await segmented();
  const { runs, carrying, tracked } = clip;
  const found = versionOf(tracked());
  const both = (): Promise<unknown> => Promise.all([carrying.correct(OVER), carrying.correct(BESIDE)]);

  let seen = atFirstFrame(clip, () => runs.cancel());
  await carrying.correct(OVER);
  expect(seen).toEqual([[36, 0], [0, 0]]);
  expect(tracked()).toMatchObject({ ...found, run: { phase: 'done', cause: 'undone', changed: 0 }, past: [], future: [] });

  seen = atFirstFrame(clip, () => runs.cancel());
  await both();
  expect([...seen, sizes(tracked())]).toEqual([[36, 36], [0, 36], [0, 36]]);
  expect(sizes(tracked(), COUNT - 1)[1]).toBeGreaterThan(0);
  expect(tracked().past).toEqual([found]);
  carrying.undo();

  seen = atFirstFrame(clip, () => carrying.undo());
  await both();
  expect([...seen, sizes(tracked())]).toEqual([[36, 36], [36, 0], [36, 0]]);
  expect(tracked().past).toEqual([found]);
  const corrected = versionOf(tracked());

  // With nothing that waits, it is the one under way.
  seen = atFirstFrame(clip, () => carrying.undo());
  await carrying.correct(BESIDE);
  expect(seen).toEqual([[36, 36], [36, 0]]);
  expect(versionOf(tracked())).toEqual(corrected);
  carrying.undo();
  expect(versionOf(tracked())).toEqual(found);
  carrying.redo();
  expect(versionOf(tracked())).toEqual(corrected);
});

test('notes meanwhile are steps after it: a colour that is looked for in the palette is one', async () => {
  const clip = await segmented();
  const { carrying, tracked } = clip;
  const colour = (value: number): void => carrying.note({ colours: { 'objects-1': [value, 0, 0] } }, 'described', value > 1);
  atFirstFrame(clip, () => {
    colour(1);
    colour(2);
    carrying.note({ names: { 'objects-1': 'Disc' } }, 'described');
    colour(3);
    carrying.note({ names: { 'objects-1': 'Ball' } }, 'described');
    carrying.undo(); // that
  });
  await carrying.correct(OVER);
  const steps: unknown[] = [];
  const see = (): void => void steps.push([tracked().names['objects-1'], tracked().colours['objects-1']?.[0], sizes(tracked())[0]]);
  for (see(); tracked().past.length > 0; see()) carrying.undo();
  expect(steps).toEqual([['Disc', 3, 36], ['Disc', undefined, 36], [undefined, undefined, 36], [undefined, undefined, 0]]);
});

test('strokes that wait are carried together, and each is a step of its own', async () => {
  const clip = await segmented();
  const { runs, carrying, tracked } = clip;
  const found = versionOf(tracked());
  let count = 0;
  const { segmenter } = runs;
  const segmentClip = segmenter.segmentClip.bind(segmenter);
  segmenter.segmentClip = (...given) => ((count += 1), segmentClip(...given));
  const THIRD = rectangle(5, 4, 30);
  await Promise.all([OVER, BESIDE, THIRD].map((one) => carrying.correct(one)));
  expect(count).toBe(2);
  const all = versionOf(tracked());
  // As if they had been said at once.
  const { carrying: other, tracked: othersTracked } = await segmented();
  await other.correct(OVER);
  await other.correct({ annotations: [...BESIDE.annotations, ...THIRD.annotations] });
  expect(othersTracked().frames).toEqual(all.frames);
  const has = ({ frames }: Pick<Tracked, 'frames'>): boolean[] => [3, 4, 5].map((id) => unpacked(frames[COUNT - 1]!.runs).includes(id));
  expect(has(all)).toEqual([true, true, true]);

  const undone = async (): Promise<void> => {
    carrying.undo();
    await expect.poll(() => tracked().run.phase).toBe('done');
  };
  await undone();
  expect([has(tracked()), sizes(tracked())]).toEqual([[true, true, false], [36, 36]]);
  carrying.redo();
  expect(versionOf(tracked())).toEqual(all);
  await undone();
  await undone();
  expect(has(tracked())).toEqual([true, false, false]);
  await undone();
  expect(versionOf(tracked())).toEqual(found);

  // While they are carried it takes back the last.
  atFirstFrame(clip, () => {
    atFirstFrame(clip, () => carrying.undo());
  });
  await Promise.all([OVER, BESIDE, THIRD].map((one) => carrying.correct(one)));
  expect(has(tracked())).toEqual([true, true, false]);
});

test('what is not carried yet is known, with the masks before it, until it is; a clip that is left goes on with it', async () => {
  const { store, runs, carrying, tracked } = await segmented();
  const found = versionOf(tracked());
  const told: (readonly [boolean, number] | null)[] = [];
  store.subscribe(({ tracked: now }, before) => {
    if (now!.pending !== before.tracked!.pending) told.push(now!.pending && [now!.pending.settled.frames === found.frames, now!.pending.corrections.length]);
  });
  await Promise.all([carrying.correct(OVER), carrying.correct(BESIDE)]);
  expect(told).toEqual([[true, 1], [true, 2], [false, 1], null]);
  const both = versionOf(tracked());

  for (const _ of tracked().past) carrying.undo();
  expect(versionOf(tracked())).toEqual(found);
  const left = carrying.correct(OVER);
  runs.stop();
  await left;
  expect(versionOf(tracked())).toEqual(found);
  expect(tracked().pending).toEqual({ settled: found, corrections: [OVER] });
  carrying.resume();
  await carrying.correct(BESIDE);
  await expect.poll(() => tracked().pending).toBeNull();
  expect(tracked().frames).toEqual(both.frames);
});
