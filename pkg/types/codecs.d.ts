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

export interface PngOptions {
  /** Red, green and blue of each index, 0 to 255: the data are indices into it. `davisPalette()` is that of label images. */
  palette?: readonly (readonly [number, number, number])[] | undefined;
}

/**
 * A PNG file of 8 bits. `data` has, row by row, for each pixel one index with a palette; without one a grey level, three bytes (RGB) or four
 * (RGBA): as many as its length says.
 *
 * Rejects with code `invalid-option` for a palette, or for data that do not fill the picture.
 */
export function encodePng(width: number, height: number, data: Uint8Array, options?: PngOptions): Promise<Uint8Array>;
