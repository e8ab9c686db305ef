// The texts of the element, where a page has given no others.

import type { VeroneseSegmenterMessages } from '../../types/element-class.js';

export const ENGLISH: VeroneseSegmenterMessages = {
  noFrame: 'no frame yet',
  pair: (motions) => `the first frame with the masks of ${counted(motions, 'motion')}`,
  frame: (number, of, objects) => `frame ${number} of ${of} with the masks of ${counted(objects, 'object')}`,
  objects: 'Objects',
  object: (number) => `Object ${number}`,
  timeline: 'Frame',
  time: (number, of) => `frame ${number} of ${of}`,
  progress: 'Progress',
  play: 'Play',
  pause: 'Pause',
  busy: 'The masks are not ready yet.',
  missing: 'Frames are missing.',
  error: ({ message }) => message,
};

function counted(count: number, thing: string): string {
  return `${count} ${thing}${count === 1 ? '' : 's'}`;
}
