// The flow field that labels and motions describe: displacements u to the right and v down of each pixel to the next frame, as 32-bit floats.
// `flo` is that of the Middlebury benchmark (Baker et al., IJCV 2011), `npy` NumPy's with the shape (height, width, 2).

import { type Encoder, type Frame, Stems } from './frames.js';
import type { Settings } from './metadata.js';

/** Of a pixel without a motion: any number above 1e9, as Middlebury's own code writes it. */
const UNKNOWN = 1e10;
/** NumPy aligns the data to so many bytes. */
const ALIGNMENT = 64;

/** Of a clip, a file for each frame that moves on to a next one. */
export function flow(layout: 'flo' | 'npy') {
  return ({ one }: Settings): Encoder => {
    const stems = new Stems();
    return {
      add: (frame) => {
        const name = one ? `flow.${layout}` : `${layout}/${stems.of(frame)}.${layout}`;
        return one || frame.motions.length > 0 ? [{ name, content: field(frame, layout) }] : [];
      },
      finish: () => [],
    };
  };
}

function field({ labels, width, height, motions }: Frame, layout: 'flo' | 'npy'): Uint8Array<ArrayBuffer> {
  const matrices = new Map(motions.map(({ label, matrix }) => [label, matrix]));
  const header = layout === 'flo' ? floHeader(width, height) : npyHeader(width, height);
  const bytes = new Uint8Array(header.length + 8 * labels.length);
  bytes.set(header);
  const view = new DataView(bytes.buffer, header.length);
  const unknown = layout === 'flo' ? UNKNOWN : Number.NaN;
  labels.forEach((label, pixel) => {
    const matrix = matrices.get(label);
    const [x, y] = [pixel % width, Math.floor(pixel / width)];
    view.setFloat32(8 * pixel, matrix ? matrix[0] * x + matrix[1] * y + matrix[2] : unknown, true);
    view.setFloat32(8 * pixel + 4, matrix ? matrix[3] * x + matrix[4] * y + matrix[5] : unknown, true);
  });
  return bytes;
}

function floHeader(width: number, height: number): Uint8Array {
  // The tag is also the number 202021.25.
  const header = new TextEncoder().encode('PIEH'.padEnd(12, '\0'));
  new DataView(header.buffer).setInt32(4, width, true);
  new DataView(header.buffer).setInt32(8, height, true);
  return header;
}

function npyHeader(width: number, height: number): Uint8Array {
  const text = `{'descr': '<f4', 'fortran_order': False, 'shape': (${height}, ${width}, 2), }`;
  const length = Math.ceil((10 + text.length + 1) / ALIGNMENT) * ALIGNMENT;
  const header = new TextEncoder().encode(`?NUMPY\x01\0??${text.padEnd(length - 11)}\n`);
  header[0] = 0x93;
  new DataView(header.buffer).setUint16(8, length - 10, true);
  return header;
}
