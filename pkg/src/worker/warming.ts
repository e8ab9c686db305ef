// Work for the compiler's sake. A browser runs a module slowly at first and compiles what runs often to the end meanwhile.

import type { Pixels } from '../../types/index.js';
import type { Api } from '../calls/api.js';

/** Measured: smaller frames leave some of what is slow unused. */
const [WIDTH, HEIGHT] = [256, 192];
/** Tiles across and down, of which every other one belongs to the background. */
const TILES = 3;
/** Displacements between the frames, pixels; the first is the background's. */
const MOTIONS = [[0.3, 0.2], [2, 1], [-1, 2], [1, -2]] as const;
/** Calls go on until this time has passed. */
const MILLISECONDS = 500;

/** Segments a pair of its own again and again for a moment. */
export async function warmUp(api: Api): Promise<undefined> {
  const [first, second] = [frame(0), frame(1)];
  const until = performance.now() + MILLISECONDS;
  do await api.segmentPair(first, second, { quality: 'fast' });
  while (performance.now() < until);
}

/** Smooth texture, in tiles that move on their own. */
function frame(time: 0 | 1): Pixels {
  const data = new Uint8Array(4 * WIDTH * HEIGHT);
  for (let y = 0, pixel = 0; y < HEIGHT; y++) {
    for (let x = 0; x < WIDTH; x++, pixel++) {
      const column = Math.floor((TILES * x) / WIDTH);
      const row = Math.floor((TILES * y) / HEIGHT);
      const motion = (row + column) % 2 === 0 ? 1 + column : 0;
      const [u, v] = MOTIONS[motion] ?? MOTIONS[0];
      data.fill(texture(x - time * u, y - time * v, motion), 4 * pixel, 4 * pixel + 3);
      data[4 * pixel + 3] = 255;
    }
  }
  return { data, width: WIDTH, height: HEIGHT };
}

function texture(x: number, y: number, phase: number): number {
  return 128 + 50 * (Math.sin(0.55 * x + phase) * Math.cos(0.37 * y - phase) + 0.6 * Math.sin(0.21 * x + 0.43 * y) + 0.4 * Math.cos(0.9 * y - 0.3 * x));
}
