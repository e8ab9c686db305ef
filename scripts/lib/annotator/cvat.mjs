// Reads the masks of a CVAT file back, "CVAT for video 1.1" with polygons, without the code that wrote it.

/** The masks of each track by its id, a list by frame: one byte per pixel, 1 inside; `null` where the object is not in sight. */
export function masksOfCvat(xml, { width, height, frames }) {
  const tracks = new Map();
  for (const [, id, shapes] of xml.matchAll(/<track id="(\d+)"[^>]*>([^]*?)<\/track>/g)) {
    const masks = Array.from({ length: frames }, () => null);
    for (const [, frame, outside, points] of shapes.matchAll(/<polygon frame="(\d+)"[^>]*outside="([01])"[^>]*points="([^"]*)"/g)) {
      if (outside === '0')
        masks[Number(frame)] = filled(
          points.split(';').map((point) => point.split(',').map(Number)),
          width,
          height,
        );
    }
    tracks.set(Number(id), masks);
  }
  return tracks;
}

/** The pixels whose centres are inside a polygon by the even-odd rule. The corner of the first pixel is (0, 0). */
function filled(polygon, width, height) {
  const crossings = Array.from({ length: height }, () => []);
  for (const [k, [x, y]] of polygon.entries()) {
    const [nextX, nextY] = polygon[(k + 1) % polygon.length];
    const [top, bottom] = [Math.min(y, nextY), Math.max(y, nextY)];
    for (let row = Math.max(0, Math.ceil(top - 0.5)); row < Math.min(height, bottom - 0.5); row += 1) {
      crossings[row].push(x + ((row + 0.5 - y) / (nextY - y)) * (nextX - x));
    }
  }
  const mask = new Uint8Array(width * height);
  for (const [row, places] of crossings.entries()) {
    places.sort((one, other) => one - other);
    for (let k = 0; k + 1 < places.length; k += 2) {
      mask.fill(1, row * width + Math.max(0, Math.ceil(places[k] - 0.5)), row * width + Math.min(width, Math.ceil(places[k + 1] - 0.5)));
    }
  }
  return mask;
}
