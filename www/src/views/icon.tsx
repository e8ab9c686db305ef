//! A line drawing on a control: a path in 20 × 20 units.

import type { VNode } from 'preact';

/** `size`: pixels of the screen. */
export function Icon({ path, size = 20 }: { path: string; size?: number }): VNode {
  return (
    <svg viewBox="0 0 20 20" width={size} height={size} aria-hidden="true">
      <path d={path} />
    </svg>
  );
}
