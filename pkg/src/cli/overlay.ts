// Frames with their labels in colours.

import { UNLABELLED } from '../common/checks.js';
import { objectColour } from '../entries/colours.js';

const WHITE = [255, 255, 255] as const;

/**
 * RGB of the frame with every label but 0 tinted half and half in its colour; the dominant motion is left as it is, so that
 * what stands out is what moves.
 */
export function overlay(rgba: Uint8Array, labels: Uint8Array): Uint8Array {
  const palette = Array.from({ length: 256 }, (_, label) => (label === UNLABELLED ? WHITE : objectColour(label)));
  const rgb = new Uint8Array(labels.length * 3);
  labels.forEach((label, pixel) => {
    const colour = label === 0 ? undefined : palette[label];
    for (let channel = 0; channel < 3; channel++) {
      const value = rgba[pixel * 4 + channel] ?? 0;
      rgb[pixel * 3 + channel] = colour ? (value + (colour[channel] ?? 0)) >> 1 : value;
    }
  });
  return rgb;
}
