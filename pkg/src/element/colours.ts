// The colour of each mask; each can be replaced in CSS.

import { objectColour } from '../entries/colours.js';

/** The colour of each label as one RGBA word: `--veronese-colour-K`, else that of the palette. A canvas knows every CSS colour. */
export function coloursOf(element: Element): Uint32Array {
  const style = getComputedStyle(element);
  const context = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
  return Uint32Array.from({ length: 255 }, (_, label) => {
    const own = label === 0 ? 'transparent' : `rgb(${objectColour(label).join(' ')})`;
    const given = style.getPropertyValue(`--veronese-colour-${label}`).trim();
    return context === null ? 0 : wordOf(context, given === '' ? own : given);
  });
}

function wordOf(context: OffscreenCanvasRenderingContext2D, colour: string): number {
  context.clearRect(0, 0, 1, 1);
  context.fillStyle = 'transparent';
  context.fillStyle = colour;
  context.fillRect(0, 0, 1, 1);
  const [r = 0, g = 0, b = 0, a = 0] = context.getImageData(0, 0, 1, 1).data;
  return ((a << 24) | (b << 16) | (g << 8) | r) >>> 0;
}
