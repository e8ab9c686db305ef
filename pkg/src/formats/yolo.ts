// YOLO segmentation: one line per label, its class and one ring in shares of the image's sides.

import { type Encoder, lines, Numbering, Stems } from './frames.js';
import type { Mask } from './masks.js';
import { nameOf, type Settings } from './metadata.js';
import { Outlines, type Ring } from './outline.js';

/** Enough for an error far below a thousandth of a pixel. */
const DECIMALS = 8;
/** How far inside of its pixel a corner is moved, pixels: more than numbers of 32 bits are rounded by, and less than anybody sees. */
const INSIDE = 0.002;

/** A text for each frame, and the classes, which have the same numbers in all of them. */
export function yolo(settings: Settings): Encoder {
  const { one, tolerance, labels = [] } = settings;
  const classes = new Numbering([...settings.classes, ...labels.map((label) => nameOf(label, settings))]);
  const stems = new Stems();
  return {
    add(frame) {
      const sides: Sides = [shares(frame.width), shares(frame.height)];
      const rings = new Outlines(tolerance).singles(frame);
      const content = frame.masks.map((mask, at) => `${classes.of(mask.name) - 1} ${outline(mask, rings[at] as Ring, sides)}\n`).join('');
      return [{ name: one ? 'yolo.txt' : `yolo/labels/${stems.of(frame)}.txt`, content }];
    },
    finish() {
      const names = lines(classes.entries);
      if (one) return [{ name: 'yolo-names.txt', content: names }];
      // Labels are looked for in the folder beside that of the images, where the frames belong. Quoted as JSON, names are YAML too.
      const numbered = classes.entries.map((name, number) => `  ${number}: ${JSON.stringify(name)}`);
      return [
        { name: 'yolo/names.txt', content: names },
        { name: 'yolo/data.yaml', content: lines(['train: images', 'val: images', 'names:', ...numbered]) },
      ];
    },
  };
}

/** By which side of a half pixel, its share of the width and of the height. */
type Sides = readonly [x: [string[], string[]], y: [string[], string[]]];

function outline(mask: Mask, ring: Ring, [shareX, shareY]: Sides): string {
  const share: (string | undefined)[] = [];
  for (let k = 0; k < ring.length; k += 2) {
    const [left, up] = sideOf(mask, ring, k);
    share.push(shareX[left][2 * (ring[k] as number)], shareY[up][2 * (ring[k + 1] as number)]);
  }
  return share.join(' ');
}

/** Just behind half pixels up to a side, and just before them, as shares of it: as text, once each and not for every vertex. */
function shares(side: number): [string[], string[]] {
  const moved = (by: number) =>
    Array.from({ length: 2 * side + 1 }, (_, halves) => {
      const place = halves === 0 || halves === 2 * side ? halves / 2 + Math.min(0, by) : halves / 2 + by;
      return String(Number((Math.max(0, place) / side).toFixed(DECIMALS)));
    });
  return [moved(INSIDE), moved(-INSIDE)];
}

/**
 * Whether a vertex belongs just left of where it is, and just above: so that readers who take the whole part of it for a pixel, and draw the
 * pixels of the outline as well, have one of the mask. Around a corner these are one pixel or three, whose middle one it is.
 */
function sideOf({ left, top, width, height, pixels }: Mask, ring: Ring, at: number): [0 | 1, 0 | 1] {
  const [x, y] = [(ring[at] as number) - left, (ring[at + 1] as number) - top];
  const isInside = (toLeft: number, up: number) => {
    const [column, row] = [Math.ceil(x) - toLeft, Math.ceil(y) - up];
    return column >= 0 && row >= 0 && column < width && row < height && pixels[row * width + column] === 1;
  };
  if (!Number.isInteger(x) || !Number.isInteger(y)) {
    return [Number.isInteger(x) && !isInside(0, Number(y % 1 > 0)) ? 1 : 0, Number.isInteger(y) && !isInside(Number(x % 1 > 0), 0) ? 1 : 0];
  }
  const sides = (
    [
      [0, 0],
      [1, 0],
      [0, 1],
      [1, 1],
    ] as const
  ).filter(([toLeft, up]) => isInside(toLeft, up));
  if (sides.length === 3) {
    const sum = (axis: 0 | 1) => sides.reduce((total, side) => total + side[axis], 0);
    return [sum(0) > 1 ? 1 : 0, sum(1) > 1 ? 1 : 0];
  }
  // Of two pixels that touch at a corner the one on the right of the way there, or from there on where the way has no length.
  const along = (from: number, to: number) =>
    [0, 1].map((axis) => (ring.at((to + axis) % ring.length) as number) - (ring.at(from + axis) as number));
  const [across, down] = [along(at - 2, at), along(at, at + 2)].find(([across, down]) => across !== 0 || down !== 0) ?? [0, 0];
  const onRight = sides.find(([toLeft, up]) => (across as number) * (0.5 - up) - (down as number) * (0.5 - toLeft) > 0);
  return [...(onRight ?? sides[0] ?? [0, 0])] as [0 | 1, 0 | 1];
}
