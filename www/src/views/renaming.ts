//! Names become fields where they are: a click on one only selects its object.

/** The name that was pressed last. A second press is about it, though its row may have moved since it is selected. */
let pressed: HTMLInputElement | null = null;
const isSecond = (event: MouseEvent): boolean => {
  const again = event.detail === 2 && pressed !== null && pressed.isConnected && pressed.readOnly;
  if (again) {
    event.preventDefault();
    event.stopPropagation();
  }
  return again;
};
document.addEventListener('mousedown', (event) => {
  if (isSecond(event)) return;
  pressed = event.target instanceof HTMLInputElement && event.target.matches('.motion-name') ? event.target : null;
}, true);
document.addEventListener('click', (event) => {
  if (isSecond(event)) rename(pressed!);
}, true);

/** Lets a person change the name of an object. The background has none of its own. */
export function rename(name: HTMLInputElement): void {
  if (name.closest('#objects > li:not([data-mask="0"])') === null) return;
  name.readOnly = false;
  name.focus();
  name.select();
}

/** Lets a person change the name of the object that is selected. */
export function renameSelected(): void {
  const name = document.querySelector<HTMLInputElement>('#objects:not([hidden], [inert]) .selected .motion-name');
  if (name !== null) rename(name);
}
