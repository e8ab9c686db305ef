//! What the keyboard shortcuts do, in words: the list that `?` opens, loaded when it does.

import { element } from './markup.js';

const WORDS = {
  peek: 'Show the other frame while held',
  blink: 'Alternate between the frames',
  split: 'Split view',
  kind: 'Switch between objects and motions',
  outlines: 'Outlines',
  onion: 'Onion skin: outlines of the objects in the frames before and after',
  arrows: 'Flow arrows',
  residual: 'Residual: what the motions do not explain',
  zoomIn: 'Zoom in',
  zoomOut: 'Zoom out',
  whole: 'Fit the picture',
  actual: 'Zoom to 100 %',
  pan: 'Pan the enlarged picture',
  stepBack: 'Step back',
  stepOn: 'Step forward',
  play: 'Play the clip, or stop',
  slower: 'Play slower',
  faster: 'Play faster',
  inPoint: 'In point: segment the clip from this frame on',
  outPoint: 'Out point: segment the clip up to this frame',
  doubtful: 'Next frame where an object is least certain',
  doubtfulBefore: 'Previous frame where an object is least certain',
  corrected: 'Next corrected frame',
  correctedBefore: 'Previous corrected frame',
  select: 'Select a mask by its place in the list',
  accept: 'Accept the masks of this frame, and go to the frame that most needs a look',
  acceptAll: 'Accept the masks of all frames',
  copyOn: 'Copy the selected mask to the next frame',
  copyBack: 'Copy the selected mask to the frame before',
  lock: 'Lock the selected objects, or unlock them',
  remove: 'Delete the selected objects',
  class: 'Class of the selected objects',
  look: 'View: select masks, pan',
  brush: 'Brush: add to the selected mask',
  eraser: 'Eraser: remove from the selected mask',
  polygon: 'Polygon: add its inside to the selected mask; Enter closes it, with Shift to remove, Backspace takes a corner back',
  exact: 'Exact: what is drawn is kept pixel for pixel, and nothing follows',
  box: 'Box: make a new object of a clip; again, add to the selected one or remove from it, as a press with Shift or Alt does',
  stroke: 'With the picture focused: start or end a stroke or a box, set a corner; arrow keys move the brush',
  thinner: 'Smaller brush',
  thicker: 'Larger brush',
  undo: 'Undo',
  redo: 'Redo',
  cancel: 'Cancel',
  keys: 'Show this list',
} as const;

export type KeyName = keyof typeof WORDS;

/** A key as shown, and what it does. */
interface Line {
  readonly shown: string;
  readonly does: KeyName | '';
}

/** Fills the list. Keys without words are other ones for what the key before them does. */
export function listKeys(list: HTMLDListElement, keys: readonly Line[]): void {
  const rows: readonly Line[] = [{ shown: 'B', does: 'peek' }, ...keys, { shown: '?', does: 'keys' }];
  for (const { shown, does } of rows) {
    if (does === '') {
      list.lastElementChild?.firstElementChild?.append(' ', element('kbd', shown));
      continue;
    }
    const row = element('div');
    const term = element('dt');
    term.append(element('kbd', shown));
    row.append(term, element('dd', WORDS[does]));
    list.append(row);
  }
}
