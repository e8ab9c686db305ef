// How well masks agree with the truth; a mask has one byte per pixel.

/** The intersection over the union; 1 where both are empty. */
export function overlap(mask, truth) {
  let [both, either] = [0, 0];
  for (let p = 0; p < truth.length; p += 1) {
    both += mask[p] & truth[p];
    either += mask[p] | truth[p];
  }
  return either === 0 ? 1 : both / either;
}

/** J: the mean over frames. */
export function mean(values) {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}
