// PNG files by hand, for what no encoder would write.

import { crc32 } from 'node:zlib';

/** A chunk of a PNG. */
export function chunk(kind, content) {
  const [length, named, sum] = [Buffer.alloc(4), Buffer.concat([Buffer.from(kind, 'latin1'), content]), Buffer.alloc(4)];
  length.writeUInt32BE(content.length);
  sum.writeUInt32BE(crc32(named));
  return Buffer.concat([length, named, sum]);
}

/** A PNG of these sides, bit depth and colour type, and of chunks: kind and content. */
export function pngOf([width, height, depth, type], ...chunks) {
  const header = Buffer.from([0, 0, 0, 0, 0, 0, 0, 0, depth, type, 0, 0, 0]);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  const all = [['IHDR', header], ...chunks, ['IEND', Buffer.alloc(0)]];
  return Buffer.concat([Buffer.from('89504e470d0a1a0a', 'hex'), ...all.map(([kind, content]) => chunk(kind, content))]);
}
