//! The clip behind the page: what is seen of what is said, at once and when it has spread; what waits, is cancelled and undone. Without a browser, by
//! changes of the state in their order.

import { type ClipJournal, SegmenterPool } from 'veronese';
import { decodeImage } from 'veronese/codecs';

import type { Clip } from '../src/clips/clip.js';
import { unpacked } from '../src/result/runs.js';
import type { DecodedFrame } from '../src/frames/frame.js';
import type { Remembered } from '../src/projects/work.js';
import { Living } from '../src/session/clip/living.js';
import { Shown } from '../src/session/shown.js';
import { about, becoming, painted } from '../src/state/said.js';
import { Store } from '../src/state/state.js';
import { type Tracked, changedIn, describedIn } from '../src/state/tracked.js';
import { clipFrames, expect, unwatched as test } from './support.js';

const [WIDTH, HEIGHT, COUNT] = [60, 42, 6];
/** The frame that is corrected. */
const AT = 2;

class Journal implements ClipJournal {
  rows: Uint8Array[] = [];

  async read(): Promise<Uint8Array | undefined> {
    return this.rows.length === 0 ? undefined : new Uint8Array(Buffer.concat(this.rows));
  }

  async append(records: Uint8Array): Promise<void> {
    this.rows.push(records);
  }

  async replace(saved: Uint8Array): Promise<void> {
    this.rows = [saved];
  }
}

interface Opened {
  readonly store: Store;
  readonly living: Living;
  readonly tracked: () => Tracked;
}

/** A clip of a disc and a square, with a journal. */
async function opened(journal: ClipJournal, remembered: Remembered = {}): Promise<Opened> {
  const pictures = await Promise.all((await clipFrames(COUNT, WIDTH, HEIGHT)).map(({ buffer }) => decodeImage(buffer)));
  const clip: Pick<Clip, 'name' | 'fingerprint' | 'count' | 'frame'> = {
    name: 'clip',
    fingerprint: 'clip',
    count: COUNT,
    // The session lets the picture go that a page would draw.
    frame: async (index) => ({ ...pictures[index]!, data: pictures[index]!.data.slice(), bitmap: { close: () => undefined } }) as unknown as DecodedFrame,
  };
  const store = new Store();
  store.set({ settings: { ...store.get().settings, quality: 'fast' } });
  const shown = new Shown(store);
  const nothing = (): void => undefined;
  const keeper = { journal, said: nothing, settled: nothing };
  const living = new Living(clip as Clip, { store, shown, segmenter: new SegmenterPool({ jobs: 2 }), keeper }, remembered, Promise.resolve());
  store.set({ tracked: living.tracked, timeline: { clip: clip as Clip, first: AT, second: AT + 1 } });
  await living.opened;
  return { store, living, tracked: () => store.get().tracked! };
}

async function segmented(journal: ClipJournal = new Journal()): Promise<Opened> {
  const clip = await opened(journal);
  await clip.living.segment();
  expect(clip.tracked().run).toMatchObject({ phase: 'done', cause: 'found', changed: COUNT });
  return clip;
}

/** Paints a rectangle of 6 × 6 pixels in the corrected frame as an object. */
function paint({ living }: Opened, object: number, left: number, top: number): Promise<boolean> {
  const isIn = (p: number): boolean => p % WIDTH >= left && p % WIDTH < left + 6 && Math.floor(p / WIDTH) >= top && Math.floor(p / WIDTH) < top + 6;
  const strokes = Uint8Array.from({ length: WIDTH * HEIGHT }, (_, p) => (isIn(p) ? 1 : 255));
  return living.say((clip) => clip.annotate({ frame: AT, object, strokes }), painted(AT, object, strokes), { cause: 'corrected', frames: [AT], reach: COUNT });
}

/** A new object over the disc, and another one beside it. */
const over = (clip: Opened): Promise<boolean> => paint(clip, 3, 17, 14);
const beside = (clip: Opened): Promise<boolean> => paint(clip, 4, 34, 4);
/** How many pixels each of the two has in a frame. */
const sizes = ({ frames }: Pick<Tracked, 'frames'>, index = AT): number[] => [3, 4].map((id) => unpacked(frames[index]!.runs).filter((label) => label === id).length);

/** The clip has done all that was said, and shows it. */
async function settled({ tracked }: Opened, cause: string): Promise<void> {
  await expect.poll(() => tracked().run).toMatchObject({ phase: 'done', cause });
}

const labels = ({ frames }: Tracked): number[][] => frames.map((frame) => (frame === null ? [] : [...unpacked(frame.runs)]));

test('a stroke is seen at once in its frame, and other frames as they change, with the progress', async () => {
  const clip = await segmented();
  const { store, tracked } = clip;
  const before = tracked().frames;
  const [seen, told]: [number[][], number[]] = [[], []];
  store.subscribe(({ tracked: now }, was) => {
    if (now!.frames !== was.tracked!.frames) seen.push([...before.keys()].filter((index) => now!.frames[index] !== before[index]));
    if (now!.run.phase === 'working' && now!.run !== was.tracked!.run) told.push(now!.run.labelled);
  });
  const done = over(clip);
  expect(sizes(tracked())).toEqual([36, 0]);
  expect(await done).toBe(true);
  await settled(clip, 'corrected');
  expect(tracked().run).toMatchObject({ changed: COUNT, kept: 0 });
  expect(seen[0]).toEqual([AT]);
  expect(seen.at(-1)).toEqual([...before.keys()]);
  expect(told).toEqual(told.toSorted((one, other) => one - other));
  expect(told[0]).toBe(0);
  for (const index of before.keys()) expect(sizes(tracked(), index)[0]).toBeGreaterThan(0);
  expect([...changedIn(tracked()).keys()]).toEqual([...before.keys()]);
  expect(tracked().annotated.get(AT)).toEqual({ objects: [3], prompts: [] });
});

test('what is cancelled leaves nothing, and what waits for it goes on; undo takes back what was said last', async () => {
  const clip = await segmented();
  const { living, tracked } = clip;
  const found = labels(tracked());
  const both = [over(clip), beside(clip)];
  expect(sizes(tracked())).toEqual([36, 36]);
  living.cancel();
  expect(await Promise.all(both)).toEqual([false, true]);
  await settled(clip, 'corrected');
  expect(sizes(tracked())).toEqual([0, 36]);
  expect(tracked().steps).toEqual({ undo: 1, redo: 0 });
  await living.undo();
  await settled(clip, 'undone');
  expect(labels(tracked())).toEqual(found);
  // The first masks are no step.
  expect(tracked().steps).toEqual({ undo: 0, redo: 1 });
  await living.undo();
  expect(labels(tracked())).toEqual(found);

  const again = [over(clip), beside(clip)];
  await living.undo();
  expect(await Promise.all(again)).toEqual([true, false]);
  await settled(clip, 'undone');
  expect(sizes(tracked())).toEqual([36, 0]);
  const corrected = labels(tracked());
  await living.undo();
  await settled(clip, 'undone');
  await living.redo();
  await settled(clip, 'redone');
  expect(labels(tracked())).toEqual(corrected);
});

test('what is said of objects is seen at once, also while a stroke spreads', async () => {
  const clip = await segmented();
  const { living, tracked } = clip;
  const stroke = over(clip);
  const named = living.say((now) => now.describe(1, { name: 'Disc' }), about([1], () => ({ name: 'Disc' })), { cause: 'described' });
  const coloured = living.say((now) => now.describe(1, { name: 'Disc', colour: [9, 0, 0] }, { coalesce: true }), about([1], () => ({ colour: [9, 0, 0] })), { cause: 'described' });
  const merged = living.say((now) => now.merge(1, 3), becoming(new Map([[3, 1]])), { cause: 'corrected', reach: 1 });
  expect(describedIn(tracked())).toMatchObject({ names: { 1: 'Disc' }, colours: { 1: [9, 0, 0] } });
  expect(tracked().frames.some((frame) => frame!.runs.labels.includes(3))).toBe(false);
  expect(tracked().run.phase).toBe('working');
  expect(await Promise.all([stroke, named, coloured, merged])).toEqual([true, true, true, true]);
  await settled(clip, 'corrected');
  expect(tracked().frames.some((frame) => frame!.runs.labels.includes(3))).toBe(false);
  const steps: unknown[] = [];
  for (; tracked().steps.undo > 0; await settled(clip, 'undone')) {
    steps.push([describedIn(tracked()).names[1], sizes(tracked())[0]]);
    await living.undo();
  }
  expect(steps).toEqual([['Disc', 0], ['Disc', 36], [undefined, 36]]);
});

test('a clip that is left goes on where it was, with what was said and had not spread', async () => {
  const journal = new Journal();
  const clip = await segmented(journal);
  const begun = new Promise<void>((resolve) => clip.store.subscribe(({ tracked }) => tracked!.run.phase === 'working' && tracked!.run.labelled > 0 && resolve()));
  const stroke = over(clip);
  await begun;
  const { masks, found } = clip.living;
  await clip.living.close();
  expect(await stroke).toBe(false);

  const other = await segmented();
  await over(other);
  await settled(other, 'corrected');
  const again = await opened(journal, { known: masks, found });
  await expect.poll(() => again.tracked().steps).toEqual({ undo: 1, redo: 0 });
  await expect.poll(() => labels(again.tracked())).toEqual(labels(other.tracked()));
  await again.living.undo();
  await settled(again, 'undone');
  expect(again.tracked().steps).toEqual({ undo: 0, redo: 1 });
});

test('masks that are known are not asked for again, unless they are of another revision', async () => {
  const journal = new Journal();
  const clip = await segmented(journal);
  const { masks, found } = clip.living;
  expect(masks.revisions.every((revision) => revision > 0)).toBe(true);
  await clip.living.close();
  const marked = { frames: masks.frames.map((frame) => frame && { ...frame, background: null }), revisions: masks.revisions.with(1, 1) };
  const again = await opened(journal, { known: marked, found });
  await expect.poll(() => again.tracked().frames[1]).not.toBeNull();
  expect(again.tracked().frames.map((frame) => frame!.background === null)).toEqual([true, false, true, true, true, true]);
  expect(again.tracked().run).toMatchObject({ phase: 'done', cause: 'continued' });
});
