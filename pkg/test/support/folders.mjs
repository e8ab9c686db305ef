// Folders of frames for the program, and what it leaves in folders.

import { mkdirSync, readdirSync, readFileSync, lstatSync, readlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { decode } from 'fast-png';
import { frame, png } from './frames.mjs';
import { temporaryFolder } from './program.mjs';

/** A folder with the frames f0.png, f1.png … in `frames`, and a place for results. The frames are `picture(0)`, `picture(1)` … */
export function clip(t, count, picture = (k) => frame(k / 2)) {
  const folder = temporaryFolder(t);
  mkdirSync(folder.path('frames'));
  const one = (k) => folder.path('frames', `f${k}.png`);
  for (let k = 0; k < count; k++) writeFileSync(one(k), png(picture(k)));
  return { ...folder, frames: folder.path('frames'), one, out: folder.path('out') };
}

/** Every file and link below a folder, hidden ones too, with its content. */
export function tree(folder) {
  const files = {};
  for (const entry of readdirSync(folder, { recursive: true })) {
    const path = join(folder, entry);
    const status = lstatSync(path);
    files[entry] = status.isSymbolicLink() ? `-> ${readlinkSync(path)}` : status.isDirectory() ? 'folder' : readFileSync(path, 'latin1');
  }
  return files;
}

/** The same without what is kept for another run, which has its history. */
export function results(folder) {
  return Object.fromEntries(Object.entries(tree(folder)).filter(([path]) => !/^\.clip[\\/]/.test(path)));
}

/** Printed lines of JSON. */
export const lines = (text) => text.trimEnd().split('\n').filter(Boolean).map((line) => JSON.parse(line));

export const tracksOf = (out) => JSON.parse(readFileSync(join(out, 'tracks.json'), 'utf8'));

/** The labels that a clip has in the k-th frame. */
export const labelsOf = (out, k) => new Uint8Array(decode(readFileSync(join(out, 'labels', `f${k}.png`))).data);
