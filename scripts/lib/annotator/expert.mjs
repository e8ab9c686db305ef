// An expert who knows the truth and wants a clip annotated with few actions: he looks at the masks, does what helps most, and looks again.
// `page` is what page.mjs gives, `truths` has the true mask of each frame.

import { mean, overlap } from './overlap.mjs';
import { depths, largest } from './regions.mjs';
import { strokeIn } from './stroke.mjs';

/** J on screen that contents him: a little above the aim, because the polygons of a file leave the borders by up to half a pixel. */
const CONTENT = 0.805;
/** A label that fits worse than this is not the object. */
const FOUND = 0.3;
/** A label is a piece of the object if J of both together is higher by this. */
const PIECE = 0.01;
/** Accepting all frames, opening the panel of exports, saving. */
const LAST = 3;
/** Radius of the smallest brush, pixels. */
const THINNEST = 2;
/** Radius of the brush that he takes, and of one that he keeps at most, as a share of how deep the region is. */
const FINE = { chosen: 1 / 3, most: 0.6 };

/** Annotates a clip with at most `most` actions. Returns the path of the file saved, the object's number there, and J before corrections. */
export async function annotate(page, files, truths, { width, most }) {
  await page.open(files);
  await page.segment();
  const { id, found } = await corrected(page, truths, width, most - LAST);
  await page.acceptAll();
  return { path: await page.save(), id, found };
}

/** Corrects as long as the object is not good enough and actions are left. */
async function corrected(page, truths, width, most) {
  let [id, found] = [null, null];
  const frames = [];
  for (;;) {
    const labels = await page.look();
    const state = await page.state();
    id ??= best(state.objects, (object) => jOf(labels, [object], truths));
    const j = id === null ? 0 : jOf(labels, [id], truths);
    page.log.push({ sees: j });
    // Once: what a box makes is the newest object, and is corrected as it is.
    const missed = found === null && j < FOUND;
    found ??= j;
    if (j >= CONTENT) return { id, found };
    const { steps, frame } = missed
      ? pointing(page, truths, width, state)
      : improving(page, { labels, truths, width, id, j, frames }, state);
    if (steps.length === 0 || page.actions() + steps.length > most) return { id, found };
    for (const step of steps) await step();
    if (frame !== undefined) frames.push(frame);
    if (missed) id = Math.max(...(await page.state()).objects);
  }
}

/** Merges a piece of the object, or paints. */
function improving(page, { labels, truths, width, id, j, frames }, state) {
  const others = state.objects.filter((other) => other !== id);
  const piece = best(others, (other) => jOf(labels, [id, other], truths));
  if (piece !== null && jOf(labels, [id, piece], truths) > j + PIECE) return { steps: page.merging(id, piece) };
  return painting(page, faultIn(labels, id, truths, width, frames), id, width, state);
}

/** A box around the object where most of it is seen. */
function pointing(page, truths, width, { frame, tool }) {
  const at = best([...truths.keys()], (index) => truths[index].reduce((sum, is) => sum + is, 0));
  const box = () => page.box(...cornersOf(truths[at], width));
  return { steps: [...(frame === at ? [] : [() => page.goTo(at)]), ...(tool === 'box' ? [] : [() => page.key('x')]), box] };
}

/** A stroke over what is missed or wrong. */
function painting(page, fault, id, width, { frame, tool, radius, objects }) {
  if (fault === null) return { steps: [] };
  const [wanted, key] = fault.missed ? ['brush', 'p'] : ['eraser', 'e'];
  const steps = [
    ...(frame === fault.frame ? [] : [() => page.goTo(fault.frame)]),
    ...(tool === wanted ? [] : [() => page.key(key)]),
    // A tool selects the largest object if none is.
    async () => ((await page.state()).selected === id ? undefined : page.key(String(1 + objects.indexOf(id)))),
    ...(radius <= FINE.most * fault.deepest ? [] : [() => page.brush(Math.max(THINNEST, Math.floor(FINE.chosen * fault.deepest)))]),
    async () => page.stroke(strokeIn(fault.mask, width, (await page.state()).radius)),
  ];
  return { steps, frame: fault.frame };
}

/**
 * The fault to correct next: the largest region that a frame misses or has wrongly, and that the thinnest brush fits into. As frames near a
 * corrected one follow it, the size of a region counts as often as its frame is away from those.
 */
function faultIn(labels, id, truths, width, corrected) {
  const away = (frame) => Math.min(truths.length, ...corrected.map((other) => Math.abs(other - frame)));
  const faults = [...truths.keys()]
    .filter((frame) => away(frame) > 0)
    .flatMap((frame) =>
      [true, false].map((missed) => {
        const wrong = truths[frame].map((is, p) => Number(missed ? is && labels[frame][p] !== id : !is && labels[frame][p] === id));
        const region = largest(wrong, width);
        return { frame, missed, weight: region.pixels * away(frame), mask: region.mask };
      }),
    );
  for (const fault of faults.sort((one, other) => other.weight - one.weight)) {
    const deepest = depths(fault.mask, width).reduce((a, b) => Math.max(a, b));
    if (deepest > THINNEST + 1) return { ...fault, deepest };
  }
  return null;
}

/** J of labels together. */
function jOf(labels, ids, truths) {
  return mean(
    truths.map((truth, index) =>
      overlap(
        labels[index].map((label) => Number(ids.includes(label))),
        truth,
      ),
    ),
  );
}

/** The first of those with the highest value; `null` of none. */
function best(all, valueOf) {
  return all.map((one) => ({ one, value: valueOf(one) })).reduce((a, b) => (a !== null && a.value >= b.value ? a : b), null)?.one ?? null;
}

/** Two corners of the smallest box around a mask. */
function cornersOf(mask, width) {
  const places = [...mask.keys()].filter((p) => mask[p]);
  const [columns, rows] = [places.map((p) => p % width), places.map((p) => Math.floor(p / width))];
  return [
    [columns.reduce((a, b) => Math.min(a, b)), rows[0]],
    [columns.reduce((a, b) => Math.max(a, b)), rows.at(-1)],
  ];
}
