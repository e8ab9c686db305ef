//! The pieces of a mask: pixels that touch along a row or column.

/** The pixels of this label without those of its largest piece; empty if it is in one piece. */
export function smallerPieces(labels: Uint8Array, width: number, label: number): number[] {
  const seen = new Uint8Array(labels.length);
  const pieces: number[][] = [];
  for (let start = 0; start < labels.length; start++) {
    if (labels[start] !== label || seen[start] === 1) continue;
    const piece = [start];
    seen[start] = 1;
    const visit = (p: number): void => {
      if (labels[p] !== label || seen[p] === 1) return;
      seen[p] = 1;
      piece.push(p);
    };
    for (let k = 0; k < piece.length; k++) {
      const p = piece[k]!;
      const x = p % width;
      if (x > 0) visit(p - 1);
      if (x < width - 1) visit(p + 1);
      visit(p - width);
      visit(p + width);
    }
    pieces.push(piece);
  }
  return pieces.sort((one, other) => other.length - one.length).slice(1).flat();
}
