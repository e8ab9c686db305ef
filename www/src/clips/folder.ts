//! A folder of frames as a clip, in the order of their names.

import { folderOf, nameOfFile } from '../frames/files.js';
import { type DecodedFrame, frameFromBlob } from '../frames/frame.js';
import type { SampleClip } from '../frames/samples.js';
import type { Clip, Picture } from './clip.js';

export async function openFolder(files: readonly File[], sample?: SampleClip): Promise<Clip> {
  const size = await frameFromBlob(files[0]!, nameOfFile(files[0]!), Infinity);
  size.bitmap.close();
  // The first frame and the sizes of all files tell folders apart without reading them.
  const fingerprint = [size.fingerprint, ...files.map((file) => file.size)].join(' ');
  return new Folder(files, fingerprint, size.width, size.height, sample);
}

class Folder implements Clip {
  readonly exact = true;
  readonly times = null;
  readonly name: string;
  readonly count: number;

  constructor(
    readonly files: readonly File[],
    readonly fingerprint: string,
    readonly width: number,
    readonly height: number,
    readonly sample: SampleClip | undefined,
  ) {
    this.name = folderOf(files[0]!) ?? files[0]!.name;
    this.count = files.length;
  }

  frame(index: number, longestSide: number): Promise<DecodedFrame> {
    const file = this.files[index]!;
    return frameFromBlob(file, nameOfFile(file), longestSide);
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
    return nameOfFile(this.files[index]!);
  }

  close(): void {}
}
