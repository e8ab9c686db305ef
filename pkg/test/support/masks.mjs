// Label images to encode: the cases that break encoders, then random ones. Seeded: the same every time.

import { compressed as compress } from '../../build/formats/coco-rle.js';
import { random } from '../../../scripts/lib/random.mjs';

/** A label image of rows of text: `.` is 255, digits are labels. */
export function drawn(...rows) {
  const labels = Uint8Array.from(rows.join(''), (character) => (character === '.' ? 255 : Number(character)));
  return { labels, width: rows[0].length, height: rows.length };
}

const CASES = [
  drawn('.'),
  drawn('0'),
  drawn('...', '...'),
  drawn('111', '111'),
  drawn('....', '.2..', '....'),
  drawn('00000', '01110', '01010', '01110', '00000'),
  drawn('1.1', '.1.', '1.1'),
  drawn('.1.', '1.1', '.1.'),
  drawn('1111111', '1.1.1.1', '1111111', '1.1.1.1', '1111111'),
  drawn('1111111', '1.....1', '1.111.1', '1.1.1.1', '1.111.1', '1.....1', '1111111'),
  drawn('11111', '1.111', '11.11', '111.1', '11111'),
  drawn('0123456789'),
  drawn('1', '.', '1', '.'),
  drawn('1111', '1..1', '1.11', '1111'),
];

/** At least `count` label images. */
export function labelImages(count) {
  const next = random(7);
  const whole = (from, to) => from + Math.floor(next() * (to - from + 1));
  const images = [...CASES];
  while (images.length < count) {
    const [width, height] = [whole(1, 40), whole(1, 40)];
    const labels = new Uint8Array(width * height).fill(next() < 0.5 ? 0 : 255);
    if (images.length % 3 === 0) {
      // Noise: everything touches everything at corners, holes in holes.
      const most = whole(1, 4);
      const density = next();
      labels.forEach((_, at) => {
        if (next() < density) labels[at] = whole(0, most);
      });
    } else {
      for (let shape = whole(1, 8); shape > 0; shape--) {
        const label = next() < 0.3 ? 255 : whole(0, 5);
        const [cx, cy, rx, ry] = [next() * width, next() * height, 1 + next() * 12, 1 + next() * 12];
        const round = next() < 0.5;
        labels.forEach((_, at) => {
          const [u, v] = [((at % width) - cx) / rx, (Math.floor(at / width) - cy) / ry];
          if (round ? u * u + v * v < 1 : Math.max(Math.abs(u), Math.abs(v)) < 1) labels[at] = label;
        });
      }
    }
    images.push({ labels, width, height });
  }
  return images;
}

/** COCO's run lengths of the pixels that are not 0, column by column. */
export function rleOf(mask, width, height, { compressed = true } = {}) {
  const counts = [0];
  let value = 0;
  for (let at = 0; at < mask.length; at++) {
    const pixel = Number(mask[(at % height) * width + Math.floor(at / height)] !== 0);
    if (pixel === value) counts[counts.length - 1]++;
    else counts.push(1);
    value = pixel;
  }
  return { size: [height, width], counts: compressed ? compress(counts) : counts };
}

/** Pixels whose middles are in rings, each x and y of one vertex after another, by the even-odd rule; `offset`: where in a pixel that is. */
export function filled(rings, { width, height }, offset = 0.5) {
  const pixels = new Uint8Array(width * height);
  for (const ring of rings) {
    for (let at = 0; at < ring.length; at += 2) {
      const [x0, y0] = [ring[at], ring[at + 1]];
      const [x1, y1] = [ring[(at + 2) % ring.length], ring[(at + 3) % ring.length]];
      for (let y = Math.max(0, Math.ceil(Math.min(y0, y1) - offset)); y < Math.max(y0, y1) - offset; y++) {
        const crossing = x0 + ((y + offset - y0) / (y1 - y0)) * (x1 - x0);
        for (let x = Math.max(0, Math.ceil(crossing - offset)); x < width; x++) pixels[y * width + x] ^= 1;
      }
    }
  }
  return pixels;
}

/** Of the pixels that one or the other has, the share that both have. */
export function intersectionOverUnion(one, other) {
  let [both, either] = [0, 0];
  one.forEach((value, at) => {
    both += Number(value && other[at]);
    either += Number(value || other[at]);
  });
  return both / either;
}

export const maskOf = (labels, label) => labels.map((value) => Number(value === label));
