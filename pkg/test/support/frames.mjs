// Small synthetic frames, and files of them made without the package's own encoder.

import { encode } from 'fast-png';

export { frame, pair } from './moving.mjs';

/** Measurements of a plane texture that moves by (u, v). */
export function points(count, u, v) {
  const positions = new Float64Array(2 * count);
  const derivatives = new Float64Array(3 * count);
  for (let j = 0; j < count; j++) {
    const [ix, iy] = [Math.cos(1.7 * j), Math.sin(2.3 * j)];
    positions.set([(j * 37) % 101, (j * 53) % 89], 2 * j);
    derivatives.set([ix, iy, -(ix * u + iy * v)], 3 * j);
  }
  return { positions, derivatives };
}

export function png({ data, width, height }) {
  return encode({ data: new Uint8Array(data.buffer), width, height, channels: 4, depth: 8 });
}

/** Binary portable pixmap. */
export function ppm({ data, width, height }) {
  const rgb = [];
  for (let i = 0; i < data.length; i += 4) rgb.push(data[i], data[i + 1], data[i + 2]);
  return Buffer.concat([Buffer.from(`P6\n${width} ${height}\n255\n`), Buffer.from(rgb)]);
}

/** Uncompressed 24-bit bitmap, rows from the bottom up. */
export function bmp({ data, width, height }) {
  const stride = Math.ceil((width * 3) / 4) * 4;
  const file = Buffer.alloc(54 + stride * height);
  file.write('BM');
  file.writeUInt32LE(file.length, 2);
  file.writeUInt32LE(54, 10);
  file.writeUInt32LE(40, 14);
  file.writeInt32LE(width, 18);
  file.writeInt32LE(height, 22);
  file.writeUInt16LE(1, 26);
  file.writeUInt16LE(24, 28);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const from = 4 * ((height - 1 - y) * width + x);
      file.set([data[from + 2], data[from + 1], data[from]], 54 + y * stride + 3 * x);
    }
  }
  return file;
}

const base64 = (text) => new Uint8Array(Buffer.from(text, 'base64'));

/** 24×20 pixels of (10 x, 12 y, 5 (x + y)), as an encoder outside this project wrote them. */
export const ramp = {
  width: 24,
  height: 20,
  colour: (x, y) => [10 * x, 12 * y, 5 * (x + y)],
  webp: base64('UklGRjAAAABXRUJQVlA4TCQAAAAvF8AEALmM6H/sIqL/ASEBYYD/m1VtFBSkbcDCdicmAPC1vhE='),
  jpeg: base64(
    '/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAA0JCgsKCA0LCgsODg0PEyAVExISEyccHhcgLikxMC4pLSwzOko+MzZGNywtQFdBRkxOUlNSMj5aYVpQ' +
    'YEpRUk//2wBDAQ4ODhMREyYVFSZPNS01T09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT0//wAARCAAUABgD' +
    'ASIAAhEBAxEB/8QAHwAAAQUBAQEBAQEAAAAAAAAAAAECAwQFBgcICQoL/8QAtRAAAgEDAwIEAwUFBAQAAAF9AQIDAAQRBRIhMUEGE1FhByJxFDKB' +
    'kaEII0KxwRVS0fAkM2JyggkKFhcYGRolJicoKSo0NTY3ODk6Q0RFRkdISUpTVFVWV1hZWmNkZWZnaGlqc3R1dnd4eXqDhIWGh4iJipKTlJWWl5iZ' +
    'mqKjpKWmp6ipqrKztLW2t7i5usLDxMXGx8jJytLT1NXW19jZ2uHi4+Tl5ufo6erx8vP09fb3+Pn6/8QAHwEAAwEBAQEBAQEBAQAAAAAAAAECAwQF' +
    'BgcICQoL/8QAtREAAgECBAQDBAcFBAQAAQJ3AAECAxEEBSExBhJBUQdhcRMiMoEIFEKRobHBCSMzUvAVYnLRChYkNOEl8RcYGRomJygpKjU2Nzg5' +
    'OkNERUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6goOEhYaHiImKkpOUlZaXmJmaoqOkpaanqKmqsrO0tba3uLm6wsPExcbHyMnK0tPU1dbX' +
    '2Nna4uPk5ebn6Onq8vP09fb3+Pn6/9oADAMBAAIRAxEAPwDiILHpxWlBY9OK1ILHpxWjBY9OKiNQzweO8zLgsenFFdNBY9OKK3VQ+kpY73dyOCFO' +
    'OK0oIU44oorz4n51g2zRghTjiiiitkfSUm+U/9k=',
  ),
};

/** The JPEG with an Exif block that says: turn a quarter clockwise to show. */
export function turnedJpeg() {
  const exif = Buffer.from('ffe100224578696600004d4d002a00000008000101120003000000010006000000000000', 'hex');
  return Buffer.concat([ramp.jpeg.subarray(0, 20), exif, ramp.jpeg.subarray(20)]);
}
