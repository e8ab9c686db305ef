//! Fingerprints recognise a frame that is opened again by the content of its file, not by name or date. They are not cryptographic.

/** Bytes read at the beginning, in the middle and at the end of a video. */
const SAMPLE = 1 << 18;

/** Hashes the whole content of an image. */
export async function fingerprintOfImage(blob: Blob): Promise<string> {
  return hashOf(await blob.arrayBuffer());
}

/** Hashes the size of a video and three samples of its content, because videos are large. */
export async function fingerprintOfVideo(blob: Blob): Promise<string> {
  const starts = [0, Math.max(0, (blob.size - SAMPLE) / 2), Math.max(0, blob.size - SAMPLE)];
  const parts = starts.map((start) => blob.slice(start, start + SAMPLE));
  return `${blob.size} ${hashOf(await new Blob(parts).arrayBuffer())}`;
}

/** Hashes a text, for names of files. */
export function fingerprintOfText(text: string): string {
  return hashOf(new TextEncoder().encode(text).buffer);
}

/** A 64-bit hash. `crypto.subtle` is unavailable on pages without https. */
function hashOf(buffer: ArrayBuffer): string {
  const whole = buffer.byteLength >> 2;
  const words = new Uint32Array(buffer, 0, whole);
  let [a, b] = [0xdead_beef ^ buffer.byteLength, 0x41c6_ce57];
  const mix = (value: number): void => {
    a = Math.imul(a ^ value, 2_654_435_761);
    b = Math.imul(b ^ value, 1_597_334_677);
    a ^= b >>> 15;
    b ^= a >>> 13;
  };
  for (const word of words) mix(word);
  for (const byte of new Uint8Array(buffer, 4 * whole)) mix(byte);
  return [a, b].map((half) => (half >>> 0).toString(16).padStart(8, '0')).join('');
}
