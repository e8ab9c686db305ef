//! A folder of frames as a clip, in the order of their names.

import { strings } from '../common/strings.js';
import { folderOfAll, nameIn } from '../frames/files.js';
import { fingerprintOfImage } from '../frames/fingerprints.js';
import { type DecodedFrame, frameFromFile } from '../frames/frame.js';
import type { Sample } from '../frames/samples.js';
import type { Clip, OtherSize, Picture } from './clip.js';

export async function openFolder(files: readonly File[], sample?: Sample): Promise<Clip> {
  const size = await frameFromFile(files[0]!, nameIn(folderOfAll(files), files[0]!), Infinity);
  size.bitmap.close();
  // The first frame, the last, and the sizes of all files tell folders apart without reading them.
  const fingerprint = [size.fingerprint, await fingerprintOfImage(files.at(-1)!), ...files.map((file) => file.size)].join(' ');
  return new Folder(files, fingerprint, size.width, size.height, sample);
}

class Folder implements Clip {
  readonly times = null;
  readonly name: string;
  readonly count: number;
  readonly #path: string;
  #closed = false;

  constructor(
    readonly files: readonly File[],
    readonly fingerprint: string,
    readonly width: number,
    readonly height: number,
    readonly sample: Sample | undefined,
  ) {
    this.#path = folderOfAll(files);
    const [first, last] = [0, files.length - 1].map((index) => this.nameOf(index).replace(/\.[^.]*$/, ''));
    this.name = this.#path === '' ? strings.fromTo(first!, last!, files.length) : this.#path;
    this.count = files.length;
  }

  frame(index: number, longestSide: number): Promise<DecodedFrame> {
    return frameFromFile(this.files[index]!, this.nameOf(index), longestSide);
  }

  async thumbnails(indices: readonly number[], draw: (index: number, picture: Picture) => void): Promise<void> {
    for (const index of indices) {
      const bitmap = await createImageBitmap(this.files[index]!, { resizeHeight: 96 }).catch(() => null);
      if (bitmap === null) continue; // choosing the frame reports the error
      draw(index, (context, x, y, width, height) => context.drawImage(bitmap, x, y, width, height));
      bitmap.close();
    }
  }

  nameOf(index: number): string {
    return nameIn(this.#path, this.files[index]!);
  }

  async otherSize(): Promise<OtherSize | null> {
    for (const [index, file] of this.files.entries()) {
      if (this.#closed) return null;
      const size = await sizeOf(file);
      if (size !== null && (size.width !== this.width || size.height !== this.height)) return { index, ...size };
    }
    return null;
  }

  close(): void {
    this.#closed = true;
  }
}

/** The size of an image as it is shown, without decoding it; `null` if it cannot be read, which choosing the frame reports. */
async function sizeOf(file: File): Promise<Pick<OtherSize, 'width' | 'height'> | null> {
  const image = new Image();
  try {
    const bytes = await file.arrayBuffer();
    return await new Promise((resolve) => {
      image.addEventListener('load', () => resolve({ width: image.naturalWidth, height: image.naturalHeight }));
      image.addEventListener('error', () => resolve(null));
      image.src = URL.createObjectURL(new Blob([bytes], { type: file.type }));
    });
  } catch {
    return null;
  } finally {
    URL.revokeObjectURL(image.src);
  }
}
