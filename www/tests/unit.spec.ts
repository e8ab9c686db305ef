//! Functions of the page that need no browser.

import { expect, test } from '@playwright/test';
import type { ClipEntry, ClipFrameStatus } from 'veronese';

import { inFileNames } from '../src/common/naming.js';
import { strings } from '../src/common/strings.js';
import { differingPixels, packed, unpacked } from '../src/result/runs.js';
import { eachPixel } from '../src/result/strokes.js';
import { contoursOf } from '../src/drawing/contours.js';
import { type Colour, PALETTE } from '../src/drawing/palette.js';
import { WHOLE, inPicture, panned, within, zoomedAt } from '../src/drawing/viewport.js';
import { linkFor, settingsFromHash } from '../src/export/link.js';
import { type Matrix, partsOf, visibleParts } from '../src/result/describe.js';
import { NOTATIONS } from '../src/result/matrices.js';
import { Numbering } from '../src/session/camera/numbering.js';
import { TimeLeft } from '../src/session/clip/time-left.js';
import { refined } from '../src/session/clip/drawing.js';
import { Pace } from '../src/session/playing.js';
import { DEFAULT_SETTINGS } from '../src/state/settings.js';
import { INITIAL } from '../src/state/state.js';
import { becoming, painted } from '../src/state/said.js';
import { type ClipState, type Prompt, type TrackedFrame, livesOf, promptOf, toReview } from '../src/state/tracked.js';

const MATRIX: Matrix = [0.01, -0.02, 4, 0.03, 0.015, -2.5];

test('a stroke covers the pixels under it', () => {
  const under = new Set<number>();
  // Points outside the frame are allowed.
  for (const points of [[3, 5, 12, 5], [-50, -50, -40, -40]]) eachPixel({ points, radius: 1.5 }, 20, 12, (p) => under.add(p));
  for (let p = 0; p < 240; p++) {
    const [x, y] = [p % 20, Math.floor(p / 20)];
    const distance = Math.hypot(x - Math.min(Math.max(x, 3), 12), y - 5);
    if (distance < 1.2) expect(under).toContain(p);
    if (distance > 1.5) expect(under).not.toContain(p);
  }
});

test('all notations of a motion move pixels the same way', () => {
  const [json, svg, openCv] = NOTATIONS.map(({ write }) => write(MATRIX));
  expect(JSON.parse(json!)).toEqual(MATRIX);
  const [x, y] = [30, 70];
  const [a11, a12, a13, a21, a22, a23] = MATRIX;
  const moved = [x + a11 * x + a12 * y + a13, y + a21 * x + a22 * y + a23];
  const rows = JSON.parse(openCv!) as number[][];
  rows.forEach(([p, q, r], k) => expect(p! * x + q! * y + r!).toBeCloseTo(moved[k]!, 6));
  // SVG measures from the corner of the first pixel, half a pixel from its centre.
  const [a, b, c, d, e, f] = svg!.match(/-?[\d.]+(e-?\d+)?/g)!.map(Number) as [number, number, number, number, number, number];
  expect(a * (x + 0.5) + c * (y + 0.5) + e - 0.5).toBeCloseTo(moved[0]!, 6);
  expect(b * (x + 0.5) + d * (y + 0.5) + f - 0.5).toBeCloseTo(moved[1]!, 6);
});

test('a link holds the settings, and invalid values are ignored', () => {
  const settings = { ...DEFAULT_SETTINGS, motions: 3, quality: 'fast' as const, markUnknown: true };
  const link = linkFor({ ...INITIAL, settings }, 'https://example.org/veronese/?x=1#old');
  expect(link).toBe('https://example.org/veronese/?x=1#motions=3&quality=fast&markUnknown=true');
  expect(settingsFromHash(new URL(link).hash)).toEqual({ settings: { motions: 3, quality: 'fast', markUnknown: true }, sample: null, automatic: null });
  const asked = linkFor({ ...INITIAL, automatic: false }, 'https://example.org/');
  expect(asked).toBe('https://example.org/#segment=asked');
  expect(settingsFromHash(new URL(asked).hash).automatic).toBe(false);
  expect(linkFor(INITIAL, 'https://example.org/')).toBe('https://example.org/');
  expect(settingsFromHash('#motions=11&quality=silly&markUnknown=1&other=1')).toEqual({ settings: {}, sample: null, automatic: null });
});

test("a clip's name makes names of files: nothing of it is lost but the extension of a video", () => {
  const names = [strings.fromTo('00000', '00032', 33), strings.fromTo('shot.0001', 'shot.0033', 33), 'My clip.mp4', 'data/JPEGImages/bear', 'v1.5'];
  expect(names.map(inFileNames)).toEqual(['00000_to_00032', 'shot.0001_to_shot.0033', 'My_clip', 'data_JPEGImages_bear', 'v1.5']);
});

/** A frame of 4 pixels a row; an object for each label but 0 and 255. */
function cameraFrame(...labels: number[]): Parameters<Numbering['numbered']>[0] {
  const ids = [...new Set(labels)].filter((label) => label > 0 && label < 255).sort((one, other) => one - other);
  return { labels: Uint8Array.from(labels), objects: ids.map((id) => ({ id, pixels: 1, bbox: [0, 0, 1, 1], confidence: 1, matrix: null })), background: null };
}

test('objects before the camera keep their numbers when another stream takes over', () => {
  const numbering = new Numbering();
  const seen = (...labels: number[]): number[] => [...numbering.numbered(cameraFrame(...labels)).labels];
  numbering.renew();
  expect(seen(0, 0, 1, 1, 255, 255)).toEqual([0, 0, 1, 1, 255, 255]);
  expect(seen(2, 2, 1, 1, 0, 0)).toEqual([2, 2, 1, 1, 0, 0]);
  numbering.renew();
  expect(seen(0, 0, 0, 0, 0, 255)).toEqual([0, 0, 0, 0, 0, 255]); // nothing is found yet
  // The same pixels are the same object, whatever the new stream calls it; a new one has a number that was never used.
  expect(seen(1, 1, 2, 2, 3, 3)).toEqual([2, 2, 1, 1, 3, 3]);
  expect(numbering.numbered(cameraFrame(1, 2, 3, 0, 0, 0)).objects.map(({ id }) => id)).toEqual([2, 1, 3]);
  // Too little in common: another object.
  numbering.renew();
  expect(seen(0, 0, 0, 0, 0, 0)).toEqual([0, 0, 0, 0, 0, 0]);
  expect(seen(1, 1, 1, 1, 1, 1)).toEqual([4, 4, 4, 4, 4, 4]);
  // Another size of the frames has nothing to compare.
  numbering.renew();
  expect(seen(1, 1)).toEqual([5, 5]);
});

test('numbers before the camera are used again when all have been, but none twice at a time', () => {
  const numbering = new Numbering();
  for (let stream = 0; stream < 300; stream++) {
    numbering.renew();
    // The first object stays and each stream has one of its own.
    const { objects } = numbering.numbered(cameraFrame(1, 1, 1, 1, ...Array.from({ length: 4 }, () => 0)));
    expect(objects.map(({ id }) => id)).toEqual([1]);
    const { objects: both } = numbering.numbered(cameraFrame(1, 1, 1, 1, 0, 0, 2, 2));
    expect(both.map(({ id }) => id)).toEqual([1, 2 + (stream % 253)]);
  }
});

const prompt = (object: number, clicks: Prompt['clicks'], box: Prompt['box'] = null): Prompt => ({ object, clicks, box });

test('a prompt is refined by clicks and a box, which has all that is the object', () => {
  const first = prompt(3, [[4, 4, 1]]);
  expect(refined(first, [6, 1, -1])).toEqual(prompt(3, [[4, 4, 1], [6, 1, -1]]));
  const boxed = refined(first, [0, 0, 3, 3]);
  expect(boxed).toEqual(prompt(3, [[4, 4, 1]], [0, 0, 5, 5]));
  expect(refined(boxed, [7, 2, 1]).box).toEqual([0, 0, 8, 5]);
  expect(refined(boxed, [9, 9, -1]).box).toEqual([0, 0, 5, 5]);
  // The last click on a pixel counts.
  expect(refined(first, [4, 4, -1]).clicks).toEqual([[4, 4, -1]]);
  const annotated = new Map([[0, { objects: [1], prompts: [first] }]]);
  expect([promptOf({ annotated }, 0, 3), promptOf({ annotated }, 0, 1), promptOf({ annotated }, 1, 3), promptOf({ annotated }, null, null)]).toEqual([first, null, null, null]);
});

test('what is painted is seen where it may be: not on locked objects, and an eraser takes its own object away', () => {
  const runs = packed(Uint8Array.of(1, 1, 2, 3, 3, 0), 6, 1);
  const entry = (number: number, locked = false): ClipEntry => ({ number, name: '', class: '', locked, annotated: false, became: number });
  const start: ClipState = { frames: [{ runs, objects: [], background: null }], status: [], objects: [entry(1), entry(2), entry(3, true)], annotated: new Map() };
  const shown = ({ frames }: ClipState): number[] => [...unpacked(frames[0]!.runs)];
  const everywhere = (label: number): Uint8Array => new Uint8Array(6).fill(label);
  expect(shown(painted(0, 1, everywhere(1))(start))).toEqual([1, 1, 1, 3, 3, 1]);
  expect(shown(painted(0, 1, everywhere(0))(start))).toEqual([0, 0, 2, 3, 3, 0]);
  expect(shown(painted(0, 0, everywhere(0))(start))).toEqual([0, 0, 0, 3, 3, 0]);
  const made = painted(0, 4, Uint8Array.of(255, 1, 1, 1, 255, 255))(start);
  expect(shown(made)).toEqual([1, 4, 4, 3, 3, 0]);
  expect(made.frames[0]!.objects.map(({ id, pixels, bbox }) => [id, pixels, ...bbox])).toEqual([[1, 1, 0, 0, 1, 1], [3, 2, 3, 0, 2, 1], [4, 2, 1, 0, 2, 1]]);
  expect(made.objects.map(({ number }) => number)).toEqual([1, 2, 3, 4]);
  expect(painted(0, 1, everywhere(255))(start).frames[0]).toBe(start.frames[0]);
  expect(shown(becoming(new Map([[2, 1], [4, 0]]))(made))).toEqual([1, 0, 0, 3, 3, 0]);
});

test('a polygon has the pixels whose centres it encloses, and its contour leads around them', () => {
  const [width, height] = [7, 6];
  const labels = new Uint8Array(width * height);
  const corners = [0.5, 0.5, 5.5, 0.5, 5.5, 4.5, 3.5, 4.5, 3.5, 2.5, 0.5, 2.5];
  eachPixel({ points: corners, radius: 9, filled: true }, width, height, (p) => (labels[p]! += 1));
  expect(Array.from({ length: height }, (_, y) => labels.subarray(y * width, (y + 1) * width).join(''))).toEqual(['0000000', '0111110', '0111110', '0000110', '0000110', '0000000']);
  expect(contoursOf(labels, width, height, (label) => label > 0)).toEqual(new Map([[1, 'M1 1L6 1L6 5L4 5L4 3L1 3Z']]));
  // Beyond the frame there is nothing. A hole has a contour of its own.
  const whole = new Uint8Array(9);
  eachPixel({ points: [-9, -9, 9, -9, 9, 9, -9, 9], radius: 0, filled: true }, 3, 3, (p) => (whole[p]! += 1));
  expect([...whole]).toEqual([1, 1, 1, 1, 1, 1, 1, 1, 1]);
  expect(contoursOf(whole.with(4, 0), 3, 3, (label) => label > 0).get(1)).toBe('M0 0L3 0L3 3L0 3ZM2 1L1 1L1 2L2 2Z');
});

test('the picture always fills the view, and its pixels are at most 64 pixels of the screen', () => {
  const large = zoomedAt(WHOLE, 4, [0.5, 0.5], 1);
  expect(inPicture(panned(large, 100, -100, 1), [0, 1])).toEqual([0, 1]);
  expect(within({ zoom: 0.1, x: 0, y: 3 }, 1)).toEqual(WHOLE);
  expect(zoomedAt(WHOLE, 1e6, [0.5, 0.5], 0.5).zoom).toBe(128);
});

/** The motion whose linear part is F and that moves the pixel (120, 80) by (u, v). */
function about([f11, f12, f21, f22]: readonly [number, number, number, number], u: number, v: number): Matrix {
  const [a11, a12, a21, a22] = [f11 - 1, f12, f21, f22 - 1];
  return [a11, a12, u - a11 * 120 - a12 * 80, a21, a22, v - a21 * 120 - a22 * 80];
}

test('a motion in words: x is right, y is down, x towards y is clockwise, and a stretch keeps the area', () => {
  const [shift, angle] = [[1, 0, 0, 1] as const, (1.2 * Math.PI) / 180];
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const seldom = about([1, -0.002, 0.002, 1], 0.03, 0);
  const words: readonly (readonly [Matrix, string, reach?: number])[] = [
    [[0, 0, 0, 0, 0, 0], 'stands still'],
    [about(shift, 4.13, -0.21), 'moves 4.1 px right, 0.21 px up'],
    [about(shift, -4.13, 12), 'moves 4.1 px left, 12 px down'],
    [about([c, -s, s, c], 0, 0), 'turns 1.2° clockwise'],
    [about([c, s, -s, c], 0, 0), 'turns 1.2° anticlockwise'],
    [about([1.005, 0, 0, 1.005], 0, 0), 'grows 0.5 %'],
    [about([0.97, 0, 0, 0.97], 0, 0), 'shrinks 3 %'],
    [about([1.02, 0, 0, 1 / 1.02], 0, 0), 'stretches 4 %'],
    // Parts that move no pixel of the mask are left out.
    [seldom, 'stands still', 10],
    [seldom, 'turns 0.11° clockwise', 400],
  ];
  const annotations = (write: (parts: ReturnType<typeof visibleParts>) => string, matrix: Matrix, reach = 100): string => write(visibleParts(partsOf(matrix, [120, 80]), reach)).replaceAll('\u00a0', ' ');
  for (const [matrix, sentence, reach] of words) expect(annotations(strings.motion, matrix, reach)).toBe(sentence);
  for (const [u, v, length] of [[1.2, 14.3, '14 px down'], [-4.13, -0.21, '4.1 px left'], [3, 4, '5 px to the lower right'], [3, -4, '5 px to the upper right']] as const) {
    expect(annotations(strings.displacement, about(shift, u, v))).toBe(length);
  }
  expect(annotations(strings.displacement, about([0.97, 0, 0, 0.97], 0, 0))).toBe('shrinks 3 %');
});

test('the time left is that of the frames done last: drafts beside the first ones slowed them down', () => {
  const time = new TimeLeft(2, 22);
  expect(time.at(2, 0)).toBeNull();
  expect(time.at(3, 9000)).toBeNull(); // it waited for the module
  let left: number | null = null;
  for (let done = 4; done <= 8; done++) left = time.at(done, 9000 + 4000 * (done - 3));
  expect(left).toBe(4 * 14);
  for (let done = 9; done <= 20; done++) left = time.at(done, 29_000 + 1000 * (done - 8));
  expect(left).toBe(2);
});

test('a clip is played as fast as it was taken, and all of it if frames come late; more slowly; and faster, without those whose time is over', () => {
  /** Which frames are shown, and when, if each takes so long to read. */
  const played = (times: Float64Array | null, speed: number, reading: number): number[][] => {
    const [count, shown] = [6, [] as number[][]];
    const pace = new Pace({ times, count }, 0);
    for (let index = 0, now = 0; index < count; ) {
      now += reading;
      shown.push([index, now]);
      const { next, wait } = pace.after(index, speed, now);
      now += Math.max(0, wait);
      index = next;
    }
    return shown;
  };
  const frames = [0, 1, 2, 3, 4, 5];
  for (const speed of [0.25, 1, 2]) expect(played(null, speed, 10)).toEqual(frames.map((k) => [k, 10 + (k * 40) / speed]));
  // Of a video each frame has its own time.
  const times = Float64Array.of(0, 0.125, 0.25, 0.5, 0.625, 0.75);
  for (const speed of [0.25, 1, 2]) expect(played(times, speed, 10)).toEqual(frames.map((k) => [k, 10 + (1000 * times[k]!) / speed]));
  expect(played(null, 1, 60)).toEqual(frames.map((k) => [k, 60 * (k + 1)]));
  expect(played(null, 2, 60).map(([index]) => index)).toEqual([0, 2, 5]);
});

test('pixels whose labels differ are counted run by run', () => {
  const [one, other] = [Uint8Array.from([0, 0, 1, 1, 1, 2, 0, 0]), Uint8Array.from([0, 1, 1, 1, 2, 2, 2, 0])];
  expect(differingPixels(packed(one, 4, 2), packed(other, 4, 2))).toBe(3);
  expect(differingPixels(packed(one, 4, 2), packed(one, 4, 2))).toBe(0);
  expect(differingPixels(packed(one, 4, 2), packed(one, 8, 1))).toBe(8);
});

/** For all eyes, and for those without the cones of long and of medium waves, in linear light (Machado and others, 2009). */
const EYES = [
  [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
] as const;

/** A colour as these eyes see it, in coordinates in which equal distances look equal. */
function seenBy(colour: Colour, eyes: (typeof EYES)[number]): [number, number, number] {
  const linear = colour.map((value) => (value <= 10 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
  const [r, g, b] = eyes.map((row) => Math.max(0, row.reduce<number>((sum, entry, k) => sum + entry * linear[k]!, 0))) as [number, number, number];
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s, 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s, 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}

test('twenty objects have colours that are apart, also to the colour-blind; those after the eighth are bright', () => {
  const colours = PALETTE.slice(1, 21);
  for (const colour of colours.slice(8)) expect(seenBy(colour, EYES[0])[0]).toBeGreaterThan(0.6);
  for (const [k, eyes] of EYES.entries()) {
    const seen = colours.map((colour) => seenBy(colour, eyes));
    const distances = seen.flatMap((one, i) => seen.slice(0, i).map((other) => Math.hypot(...one.map((value, axis) => value - other[axis]!))));
    expect(Math.min(...distances)).toBeGreaterThan(k === 0 ? 0.09 : 0.058);
  }
});

test('the frame that lost an object is looked at first, unless it left through the border', () => {
  const frame = (...objects: [number, number, number][]): TrackedFrame => ({
    runs: packed(new Uint8Array(32), 8, 4),
    objects: objects.map(([id, x, confidence]) => ({ id, pixels: 4, bbox: [x, 1, 2, 2], confidence, matrix: null })),
    background: null,
  });
  const frames = [frame([1, 2, 0.6], [2, 2, 0.8]), frame([1, 3, 0.9], [2, 0, 0.7]), frame([1, 4, 0.9]), frame(), null];
  expect(livesOf({ frames }).map(({ id, first, last, doubtful }) => [id, first, last, doubtful])).toEqual([
    [1, 0, 2, { index: 3, confidence: 0 }],
    [2, 0, 1, { index: 1, confidence: 0.7 }],
  ]);
  const status = (...accepted: number[]): ClipFrameStatus[] => frames.map((_, index) => ({ hasMasks: true, accepted: accepted.includes(index), annotated: false, revision: 1 }));
  expect(toReview({ frames, status: status() }, 0)).toBe(3);
  expect(toReview({ frames, status: status(3) }, 3)).toBe(0);
  // Of several that are as doubtful, the next one.
  const alike = [0, 1, 2, 3].map(() => frame([1, 2, 0.6]));
  expect([0, 1, 3].map((from) => toReview({ frames: alike, status: status() }, from))).toEqual([1, 2, 0]);
});
