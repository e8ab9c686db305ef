//! Drawing under an affine motion. A canvas measures from the corner of a pixel, the package from its centre: half a pixel apart.

/** The canvas transform that carries what is drawn at first-frame places to where the motion puts it in the second frame. */
export function transformOf(matrix: readonly number[]): DOMMatrix {
  const [a11 = 0, a12 = 0, a13 = 0, a21 = 0, a22 = 0, a23 = 0] = matrix;
  // x' = F (x − ½) + t + ½ with F = I + A
  return new DOMMatrix([1 + a11, a21, a12, 1 + a22, a13 - (a11 + a12) / 2, a23 - (a21 + a22) / 2]);
}

/** Draws the second frame so that what moves with the motion stands where it stood in the first. */
export function drawStabilised(context: CanvasRenderingContext2D, second: ImageBitmap, matrix: readonly number[]): void {
  const back = transformOf(matrix).inverse();
  if (!Number.isFinite(back.a)) return; // a motion that flattens the frame cannot be undone
  context.setTransform(back);
  context.drawImage(second, 0, 0);
  context.resetTransform();
}
