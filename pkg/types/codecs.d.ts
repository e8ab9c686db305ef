// Image files under Node. This module uses a second WebAssembly build, which is loaded on first use. Calls copy their bytes before they
// return. Arguments of the wrong type, and invalid sizes, are rejected with code `invalid-input`.

/** A decoded image: RGBA bytes, row by row. */
export interface Picture {
  data: Uint8Array;
  width: number;
  height: number;
  /** Of a file with samples of 16 bits: the smallest and the largest one, alpha aside. */
  range?: [number, number];
}

export interface DecodeOptions {
  /** Takes a JPEG file of which a part is missing or damaged as far as it goes; the rest is grey. Default: false, it is `unreadable-image`. */
  allowDamaged?: boolean;
  /** Of samples of 16 bits: those that become 0 and 255. Default: `[0, 65535]`, of which cameras may use a small part. */
  range?: readonly [number, number];
  /**
   * Scales a larger picture down so that its longest side has so many pixels, 1 to 4096; files may then have sides up to 16384. Each pixel is
   * the mean of the area that it covers.
   */
  maxSize?: number | undefined;
}

/**
 * Decodes a PNG, JPEG, WebP, BMP or PNM file; an Exif orientation is applied. What is appended to a JPEG file is not read.
 *
 * Rejects with code `unreadable-image`, or `frame-size-unsupported` for a side of 0, or above 4096 pixels without `maxSize`.
 */
export function decodeImage(file: Uint8Array, options?: DecodeOptions): Promise<Picture>;

/** An 8-bit indexed PNG: one palette index per pixel. Rejects with code `invalid-option`. */
export function encodeIndexedPng(
  width: number,
  height: number,
  indices: Uint8Array,
  palette: readonly (readonly [number, number, number])[],
): Promise<Uint8Array>;

/** An 8-bit grey PNG: one byte per pixel. Rejects with code `invalid-option`. */
export function encodeGreyPng(width: number, height: number, grey: Uint8Array): Promise<Uint8Array>;

/** An RGB PNG of three bytes per pixel, or an RGBA PNG of four. Rejects with code `invalid-option`. */
export function encodeColourPng(width: number, height: number, pixels: Uint8Array): Promise<Uint8Array>;
