//! The contours of masks as paths: along the sides of pixels, closed, so that they can be dashed.

/** The contours of each label that is `wanted`, as the data of an SVG path in corners of pixels: (0, 0) is that of the picture. */
export function contoursOf(labels: Uint8Array, width: number, height: number, wanted: (label: number) => boolean): Map<number, string> {
  /** For each label the sides by their first corner. The pixel is at the right of a side, so where one ends, another begins. */
  const sides = new Map<number, Map<number, number[]>>();
  const across = width + 1;
  const add = (label: number, from: number, to: number): void => {
    const own = sides.get(label) ?? new Map<number, number[]>();
    sides.set(label, own.set(from, [...(own.get(from) ?? []), to]));
  };
  for (let y = 0, p = 0; y < height; y++) {
    for (let x = 0; x < width; x++, p++) {
      const label = labels[p]!;
      if (!wanted(label)) continue;
      const corner = y * across + x;
      if (y === 0 || labels[p - width] !== label) add(label, corner, corner + 1);
      if (x === width - 1 || labels[p + 1] !== label) add(label, corner + 1, corner + across + 1);
      if (y === height - 1 || labels[p + width] !== label) add(label, corner + across + 1, corner + across);
      if (x === 0 || labels[p - 1] !== label) add(label, corner + across, corner);
    }
  }
  return new Map([...sides].map(([label, own]) => [label, pathOf(own, across)]));
}

function pathOf(sides: Map<number, number[]>, across: number): string {
  let path = '';
  for (const [start, left] of sides) {
    while (left.length > 0) {
      path += `M${start % across} ${Math.floor(start / across)}`;
      let [at, by] = [start, 0];
      do {
        const to = sides.get(at)!.pop()!;
        // A corner only where the contour turns.
        if (by !== 0 && to - at !== by) path += `L${at % across} ${Math.floor(at / across)}`;
        [at, by] = [to, to - at];
      } while (at !== start);
      path += 'Z';
    }
  }
  return path;
}
