//! Which keys belong to the element that has the focus.

/** What was pressed last with a pointer, until Tab moves the focus. `:focus-visible` matches that too, after any key. */
let pressed: Node | null = null;
document.addEventListener('pointerdown', ({ target }) => (pressed = target instanceof Node ? target : null), { capture: true, passive: true });
document.addEventListener('keydown', ({ key }) => {
  if (key === 'Tab') pressed = null;
}, true);

/** Whether the element takes typed text, so that single keys are not shortcuts. */
export function takesText(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.matches('input:not([type=radio], [type=checkbox], [type=range], [type=file], [type=color], [readonly]), select, textarea');
}

/** Whether the element matches `selector` and has the focus by keys: one that was pressed leaves the keys to the clip. */
export function isReached(target: EventTarget | null, selector: string): boolean {
  if (!(target instanceof HTMLElement) || !target.matches(selector)) return false;
  return pressed === null || !(target.closest('label') ?? target).contains(pressed);
}

/** Whether the element uses arrow keys itself. They never change the tool. */
export function takesArrows(target: EventTarget | null): boolean {
  const slides = target instanceof HTMLElement && target.matches('input[type=range], [role=slider]');
  return takesText(target) || slides || isReached(target, 'input[type=radio]:not([name=tool])');
}

/** Whether the element uses the space key itself. */
export function takesSpace(target: EventTarget | null): boolean {
  return takesText(target) || isReached(target, 'button, summary, input:not([readonly]), a');
}
