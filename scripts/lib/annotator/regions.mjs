// Regions of a mask, and a stroke that paints one. A mask has one byte per pixel.

/** The largest part of a region whose pixels share sides, as `{ mask, pixels }`. */
export function largest(region, width) {
  const left = Uint8Array.from(region);
  let best = [];
  for (let start = left.indexOf(1); start >= 0; start = left.indexOf(1, start)) {
    const part = spread(left, width, start);
    if (part.length > best.length) best = part;
  }
  const mask = new Uint8Array(region.length);
  for (const p of best) mask[p] = 1;
  return { mask, pixels: best.length };
}

/** Takes the pixels out of `left` that are connected with `start`, and returns them. */
function spread(left, width, start) {
  const part = [start];
  left[start] = 0;
  for (const p of part) {
    for (const q of [p % width > 0 ? p - 1 : -1, (p + 1) % width > 0 ? p + 1 : -1, p - width, p + width]) {
      if (left[q] !== 1) continue;
      left[q] = 0;
      part.push(q);
    }
  }
  return part;
}

/** The distance of every pixel's centre from the nearest one outside, beyond the border included; 0 outside. */
export function depths(region, width) {
  const height = region.length / width;
  const along = new Float64Array(region.length);
  for (let p = 0; p < region.length; p += 1) if (region[p]) along[p] = 1 + (p >= width ? along[p - width] : 0);
  for (let p = region.length - 1; p >= 0; p -= 1)
    if (region[p]) along[p] = Math.min(along[p], 1 + (p + width < region.length ? along[p + width] : 0));
  const found = new Float64Array(region.length);
  for (let y = 0; y < height; y += 1) {
    for (let x = 0; x < width; x += 1) {
      let least = along[y * width + x] ** 2;
      for (let aside = 1; aside * aside < least; aside += 1) {
        const [before, after] = [x - aside < 0 ? 0 : along[y * width + x - aside], x + aside >= width ? 0 : along[y * width + x + aside]];
        least = Math.min(least, aside * aside + Math.min(before, after) ** 2);
      }
      found[y * width + x] = Math.sqrt(least);
    }
  }
  return found;
}
