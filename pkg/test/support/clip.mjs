// The output folder of `veronese clip`, of labels that are drawn here: what convert reads, without the work of segmenting.

import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { davisPng } from '../../build/formats/pictures.js';

const [WIDTH, HEIGHT, LENGTH] = [37, 23, 7];

/**
 * Labels of seven frames. Object 1 is a ring around a hole that moves right. Object 2 lies at the border and is gone in frames 3 and 4.
 * Object 4 begins in frame 2 and has two parts; there is no object 3. Some pixels are unlabelled.
 */
export function drawnClip() {
  return Array.from({ length: LENGTH }, (_, frame) => {
    const labels = new Uint8Array(WIDTH * HEIGHT);
    const fill = (left, top, width, height, label) => {
      for (let y = top; y < top + height; y++) labels.fill(label, y * WIDTH + left, y * WIDTH + left + width);
    };
    fill(4 + 3 * frame, 5, 9, 8, 1);
    fill(7 + 3 * frame, 8, 3, 2 + (frame % 2), 0);
    if (frame !== 3 && frame !== 4) fill(0, 14, 5 + frame, 9, 2);
    if (frame >= 2) fill(20, 17, 6, 3, 4);
    if (frame >= 2) fill(30 - frame, 15, 2, 1 + frame, 4);
    fill(WIDTH - 2, 0, 2, frame, 255);
    return labels;
  });
}

/** The content of tracks.json for the labels. */
export function tracksOf(frames, { width = WIDTH, height = HEIGHT, names = {}, ...more } = {}) {
  const objects = new Map();
  frames.forEach((labels, frame) => {
    for (const id of [...new Set(labels)].filter((label) => label !== 0 && label !== 255).sort((a, b) => a - b)) {
      const sightings = objects.get(id) ?? [];
      objects.set(id, sightings);
      let [pixels, left, top, right, bottom] = [0, width, height, 0, 0];
      labels.forEach((label, at) => {
        if (label !== id) return;
        const [x, y] = [at % width, Math.floor(at / width)];
        pixels++;
        [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x + 1), Math.max(bottom, y + 1)];
      });
      const matrix = frame + 1 < frames.length ? [0, 0, id, 0, 0, frame / 8] : null;
      sightings.push({ frame, pixels, bbox: [left, top, right - left, bottom - top], confidence: 0.75, matrix });
    }
  });
  return {
    version: 1,
    width,
    height,
    frames: frames.map((_, frame) => `f${String(frame).padStart(3, '0')}`),
    files: frames.map((_, frame) => `f${String(frame).padStart(3, '0')}.jpg`),
    objects: [...objects].map(([id, frames]) => ({ id, ...(names[id] && { name: names[id] }), first: frames[0].frame, last: frames.at(-1).frame, frames })),
    background: frames.slice(1).map((_, frame) => ({ frame, matrix: [0, 0, 0, 0, 0, 0] })),
    dropped: 0,
    settings: {},
    ...more,
  };
}

/** Writes the folder; returns the labels and tracks.json. `options` as for {@link tracksOf}. */
export function clipFolder(folder, { frames = drawnClip(), ...options } = {}) {
  const tracks = tracksOf(frames, options);
  mkdirSync(join(folder, 'labels'), { recursive: true });
  frames.forEach((labels, frame) => writeFileSync(join(folder, 'labels', `${tracks.frames[frame]}.png`), davisPng(labels, tracks.width, tracks.height)));
  writeFileSync(join(folder, 'tracks.json'), `${JSON.stringify(tracks)}\n`);
  return { frames, tracks };
}
