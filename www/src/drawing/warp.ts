//! Drawing under an affine motion. The origin of a canvas is the corner of the first pixel, that of the package its centre.

/** The canvas transform from the first frame to the second under this motion. */
export function transformOf(matrix: readonly number[]): DOMMatrix {
  const [a11 = 0, a12 = 0, a13 = 0, a21 = 0, a22 = 0, a23 = 0] = matrix;
  // x' = F (x − ½) + t + ½ with F = I + A
  return new DOMMatrix([1 + a11, a21, a12, 1 + a22, a13 - (a11 + a12) / 2, a23 - (a21 + a22) / 2]);
}

/** Draws the second frame warped back by the motion, so that what follows it is where it was in the first frame. */
export function drawStabilised(context: CanvasRenderingContext2D, second: ImageBitmap, matrix: readonly number[]): void {
  const back = transformOf(matrix).inverse();
  if (!Number.isFinite(back.a)) return; // a singular motion has no inverse
  context.setTransform(back);
  context.drawImage(second, 0, 0);
  context.resetTransform();
}
