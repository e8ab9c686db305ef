//! Common names of the codecs that files identify.

const NAMES: Readonly<Record<string, string>> = {
  avc: 'H.264',
  hevc: 'HEVC (H.265)',
  vp8: 'VP8',
  vp9: 'VP9',
  av1: 'AV1',
  prores: 'ProRes',
  vvc1: 'VVC (H.266)',
  vvi1: 'VVC (H.266)',
  mp4v: 'MPEG-4 Part 2 (DivX, Xvid)',
  'V_MPEG4/ISO/ASP': 'MPEG-4 Part 2 (DivX, Xvid)',
  V_MPEG2: 'MPEG-2',
  jpeg: 'Motion JPEG',
  V_MJPEG: 'Motion JPEG',
};

/** The name of the first identifier that has one, else the last identifier itself. */
export function codecName(...identifiers: readonly (string | null)[]): string | null {
  const known = identifiers.filter((one) => one !== null);
  const named = known.find((one) => one in NAMES);
  return named === undefined ? (known.at(-1) ?? null) : NAMES[named]!;
}
