// A clip segmented and annotated by the package's own calls: what the program has to write.

import { openClip } from 'veronese';

/** The frames of a clip with their labels, and its tracks. `declaration` as for `replaceAnnotations`. */
export async function segmented(length, read, options, declaration = {}) {
  const clip = await openClip({ length, read });
  try {
    await clip.segment(options);
    await clip.replaceAnnotations(declaration);
    const frames = await Promise.all(Array.from({ length }, (_, index) => clip.labels(index)));
    return { frames, tracks: await clip.tracks() };
  } finally {
    await clip.close();
  }
}
