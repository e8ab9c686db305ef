//! Rows of lists of what the browser keeps, which are made anew whenever work is kept.

/** Puts rows into lists, each row with its file in `data-file`. Rows stay if they are the same; else the focus stays with its file. */
export function showRows(lists: readonly (readonly [HTMLElement, readonly HTMLElement[]])[]): void {
  const focused = document.activeElement?.closest<HTMLElement>('[data-file]')?.dataset['file'];
  for (const [list, rows] of lists) {
    const same = list.childElementCount === rows.length && rows.every((row, k) => row.isEqualNode(list.children[k]!));
    if (!same) list.replaceChildren(...rows);
  }
  if (focused === undefined || document.activeElement !== document.body) return;
  const row = lists.flatMap(([, rows]) => rows).find(({ dataset }) => dataset['file'] === focused);
  row?.querySelector('button')?.focus();
}
