// Statistics for the benchmarks.

/** The quantile at a share from 0 to 1, interpolated linearly. */
export function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  const place = share * (sorted.length - 1);
  const [below, above] = [Math.floor(place), Math.ceil(place)];
  return sorted[below] + (place - below) * (sorted[above] - sorted[below]);
}

export function median(values) {
  return quantile(values, 0.5);
}

/** The exponent of the power law through points: the slope of the line through their logarithms. */
export function exponent(points) {
  const logs = points.map(([x, y]) => [Math.log(x), Math.log(y)]);
  const mean = (k) => logs.reduce((sum, log) => sum + log[k], 0) / logs.length;
  const [mx, my] = [mean(0), mean(1)];
  const covariance = logs.reduce((sum, [p, q]) => sum + (p - mx) * (q - my), 0);
  return covariance / logs.reduce((sum, [p]) => sum + (p - mx) ** 2, 0);
}
