//! Finding the static markup. A missing element is a mistake of ours and said at once, by its selector.

type Kind<E extends Element> = abstract new (...args: never) => E;

/** The element inside `root` that `selector` names. */
export function find<E extends Element>(root: ParentNode, selector: string, kind: Kind<E>): E {
  const element = root.querySelector(selector);
  if (!(element instanceof kind)) throw new Error(`index.html has no ${kind.name} ${selector}`);
  return element;
}

/** The 2-D context of a canvas. */
export function contextOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext('2d');
  if (context === null) throw new Error('this browser gives no 2-D canvas');
  return context;
}

/** Whether the element takes typed text, so that single keys are not commands. */
export function takesText(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.matches('input:not([type=radio], [type=checkbox], [type=range], [type=file]), select, textarea');
}
