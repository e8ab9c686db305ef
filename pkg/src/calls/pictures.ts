// The pixels of pictures in browsers and their workers, or why there are none.

import type { Pixels } from '../../types/index.js';
import { invalidInput } from '../common/checks.js';
import { VeroneseError } from '../common/errors.js';

/** Of a picture of this kind, by its copy, which is closed. */
export function pixelsOfCopy(name: string, kind: string, copy: PromiseSettledResult<ImageBitmap>): Pixels {
  if (copy.status === 'rejected') throw notCopied(name, kind, copy.reason);
  try {
    return pixelsOfBitmap(copy.value);
  } catch (cause) {
    if ((cause as Error).name !== 'SecurityError') throw cause;
    throw new VeroneseError('unreadable-image', `${name} is of another origin, which does not allow this page to read it (CORS)`, {
      cause,
    });
  } finally {
    copy.value.close();
  }
}

export function pixelsOfBitmap(image: ImageBitmap): Pixels {
  const { width, height } = image;
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  if (context === null) throw new VeroneseError('internal', 'this browser gives no canvas to read pixels from');
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, width, height);
}

function notCopied(name: string, kind: string, cause: unknown): VeroneseError {
  if (typeof createImageBitmap !== 'function')
    return invalidInput(`${name} is a picture (${kind}), which nothing reads here: decode it first`);
  // Whatever calls itself a picture.
  if (cause instanceof TypeError) return invalidInput(`${name} is no picture: ${cause.message}`);
  if (kind === 'VideoFrame') return invalidInput(`${name} is a VideoFrame that is closed`);
  if (kind === 'ImageBitmap') return invalidInput(`${name} is an ImageBitmap that is closed, or was given to another thread`);
  if (kind.endsWith('Canvas') || kind === 'HTMLCanvasElement') return invalidInput(`${name} is a canvas without pixels`);
  return new VeroneseError('unreadable-image', `${name} is not an image that this browser can read`, { cause });
}
