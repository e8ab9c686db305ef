// The caller's arrays become the call's own, when the call is made: from then on the caller may write to theirs.

import type { TypedArray } from '../common/checks.js';

/**
 * Copies of what the arrays show, and of nothing else of their buffers; clamped bytes become bytes. With `transfer` it is the buffers
 * themselves, which the caller loses; those that cannot be given away (shared memory, a module's, Node's pools) are copied.
 */
export function taken(arrays: readonly TypedArray[], transfer: boolean): TypedArray[] {
  const views = arrays.map((array) => ({ array, buffer: array.buffer, start: array.byteOffset, length: array.length }));
  const moved = new Map(transfer ? [...new Set(views.map(({ buffer }) => buffer))].map((buffer) => [buffer, given(buffer)] as const) : []);
  return views.map(({ array, buffer, start, length }) => {
    const Kind = array[Symbol.toStringTag] === 'Float64Array' ? Float64Array : Uint8Array;
    const now = moved.get(buffer);
    return now ? new Kind(now, start, length) : new Kind(array as never);
  });
}

function given(buffer: ArrayBufferLike): ArrayBuffer | undefined {
  try {
    return structuredClone(buffer as ArrayBuffer, { transfer: [buffer as ArrayBuffer] });
  } catch {
    return undefined;
  }
}

/** The buffers of arrays that are the call's own: they need no other copy on their way to a worker and back. */
export function buffersOf(arrays: readonly (TypedArray | undefined)[]): ArrayBuffer[] {
  return [...new Set(arrays.flatMap((array) => (array ? [array.buffer as ArrayBuffer] : [])))];
}
