// The folder of a batch: one folder for each pair, called by its number and its first frame, which the labels belong to.

import { extname, join } from 'node:path';
import { keyOf, UNLABELLED } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';
import { entriesOf } from './files.js';
import { readPair } from './pair-folder.js';
import { CLASS, isFileName, lastOf, type Range, type Sequence, type SequenceFrame, sequenceName } from './sequence.js';

interface PairFolder {
  index: number;
  name: string;
  /** The part of the name that is that of the frame. */
  frame: string;
}

/** The pairs' folders by their numbers. Throws `unreadable-file`. */
export function pairFolders(folder: string): PairFolder[] {
  const found = entriesOf(folder).flatMap((entry): PairFolder[] => {
    const { name } = entry;
    const [, index, frame] = /^(\d{6,})-(.+)$/.exec(name) ?? [];
    return frame === undefined || !entry.isDirectory() ? [] : [{ index: Number(index), name, frame }];
  });
  return found.sort((a, b) => a.index - b.index);
}

/** A label is a motion of one pair: it has no counterpart in the next pair. */
export function openBatch(folder: string, range: Range, background: boolean, grouped: boolean): Sequence {
  const all = pairFolders(folder);
  const until = lastOf(range, all.at(-1)?.index ?? 0);
  const pairs = all.filter(({ index }) => index >= range.from && index <= until);
  if (pairs.length === 0) throw new VeroneseError('invalid-option', `there is no pair from ${range.from} to ${until}`);
  const labels = Array.from({ length: UNLABELLED }, (_, label) => label);
  return {
    meta: {
      clip: sequenceName(folder),
      names: Object.fromEntries(labels.map((label) => [label, label === 0 ? CLASS.background : CLASS.object])),
      labels: background ? labels : labels.slice(1),
      tracked: false,
    },
    count: pairs.length,
    async *[Symbol.asyncIterator]() {
      const taken = new Set<string>();
      for (const pair of pairs) {
        const frame = await readFrame(join(folder, pair.name), pair.frame, grouped);
        const stem = frame.image.slice(0, frame.image.length - extname(frame.image).length);
        if (taken.has(keyOf(stem))) throw new VeroneseError('invalid-input', `two frames have the name '${stem}'`);
        taken.add(keyOf(stem));
        yield frame;
      }
    },
  };
}

async function readFrame(folder: string, frame: string, grouped: boolean): Promise<SequenceFrame> {
  const { labels, width, height, motions, inputs } = await readPair(folder, grouped);
  const [first] = inputs;
  if (!isFileName(first))
    throw new VeroneseError('invalid-input', `'${join(folder, 'result.json')}' does not name its frames: it is not of 'veronese batch'`);
  // A frame of a video is no file: it is called what ffmpeg would write it to.
  const image = /#\d+$/.test(first) ? `${frame}.png` : first;
  return { labels, width, height, image, motions };
}
