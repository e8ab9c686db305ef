//! Several files as one zip archive.

/** A zip archive. PNG files are compressed already and only stored. */
export async function zipped(files: Record<string, Uint8Array>): Promise<Uint8Array<ArrayBuffer>> {
  const { zipSync } = await import('fflate');
  const entries = Object.entries(files).map(([name, bytes]) => [name, [bytes, { level: name.endsWith('.png') ? 0 : 6 }]]);
  return new Uint8Array(zipSync(Object.fromEntries(entries)));
}
