// The number of motions between two frames, found in a worker; it ends with the component.

import { Segmenter } from 'veronese';
import { onUnmounted, ref, watch } from 'vue';
import { pixelsOf } from './pixels.js';

export function useMotions(files) {
  const segmenter = new Segmenter();
  const motions = ref();
  watch(files, async ([first, second], _before, onCleanup) => {
    const newer = new AbortController();
    onCleanup(() => newer.abort());
    motions.value = undefined;
    if (!second) return;
    const frames = await Promise.all([pixelsOf(first), pixelsOf(second)]);
    if (newer.signal.aborted) return;
    const { count } = await segmenter.segmentPair(...frames, { quality: 'fast', signal: newer.signal }).catch(() => ({}));
    if (!newer.signal.aborted) motions.value = count;
  });
  onUnmounted(() => segmenter.close());
  return motions;
}
