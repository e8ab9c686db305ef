//! Finds static markup and makes new elements. A missing element throws at once, with its selector.

type Kind<E extends Element> = abstract new (...args: never) => E;

/** The element in `root` that matches `selector`. */
export function find<E extends Element>(root: ParentNode, selector: string, kind: Kind<E>): E {
  const element = root.querySelector(selector);
  if (!(element instanceof kind)) throw new Error(`index.html has no ${kind.name} ${selector}`);
  return element;
}

const SVG = 'http://www.w3.org/2000/svg';

/** A new SVG element with attributes. */
export function drawn<T extends keyof SVGElementTagNameMap>(tag: T, attributes: Readonly<Record<string, string | number>>): SVGElementTagNameMap[T] {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  return made;
}

/** The 2-D context of a canvas. */
export function contextOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext('2d');
  if (context === null) throw new Error('this browser gives no 2-D canvas');
  return context;
}

/** Whether a dialogue is open: what lies behind it stays as it is. */
export function isDialogueOpen(): boolean {
  return document.querySelector('dialog[open]') !== null;
}

/** Whether the user prefers reduced motion. */
export function prefersStillness(): boolean {
  return matchMedia('(prefers-reduced-motion: reduce)').matches;
}
