//! Selecting several objects in their list: with Ctrl and Shift, by boxes, and by keys.

import type { Session } from '../session/session.js';
import { type Store, selectedIn } from '../state/state.js';
import { livesOf } from '../state/tracked.js';
import { takesText } from './focused.js';

export class Selecting {
  readonly #store: Store;
  readonly #session: Session;
  readonly #list: HTMLElement;
  /** From where Shift extends. */
  #anchor: number | null = null;

  constructor(list: HTMLElement, store: Store, session: Session) {
    [this.#list, this.#store, this.#session] = [list, store, session];
    list.addEventListener('mousedown', (event) => {
      if (isExtending(event) && this.#objectAt(event) !== null) event.preventDefault(); // neither a focus nor selected text
    });
    // Before the row selects itself alone.
    list.addEventListener('click', (event) => this.#click(event), true);
    list.addEventListener('change', (event) => {
      const id = isBox(event) ? this.#objectAt(event) : null;
      if (id !== null) this.#toggle(id);
    });
    list.addEventListener('focusin', (event) => {
      if (store.get().look.among !== null) event.stopPropagation();
    }, true);
  }

  /** The objects in their order. */
  get all(): number[] {
    return livesOf(this.#store.get().tracked ?? { frames: [] }).map(({ id }) => id);
  }

  /** Those that are selected. */
  get chosen(): number[] {
    const among = selectedIn(this.#store.get().look);
    return this.all.filter((id) => among.includes(id));
  }

  choose(ids: readonly number[], selected = ids.at(-1) ?? null): void {
    this.#store.look({ among: new Set(ids), selected });
  }

  /** Selects one alone. */
  end(selected = this.#store.get().look.selected): void {
    this.#session.shown.select(selected);
  }

  /** Keys of the list, which is in a section. Returns whether it was one. `leave`: where the focus goes when the selection ends. */
  key(event: KeyboardEvent, leave: HTMLElement): boolean {
    const { key, target } = event;
    if (takesText(target) || event.altKey || !(target instanceof Node)) return false;
    const { among, selected } = this.#store.get().look;
    const command = event.ctrlKey || event.metaKey;
    if (key === 'Escape' && among !== null) {
      this.end();
      leave.focus();
      return true;
    }
    if (!this.#list.contains(target)) return false;
    const all = this.all;
    if (command && key.toLowerCase() === 'a') {
      this.choose(all);
      return true;
    }
    const by = command ? 0 : key === 'ArrowDown' ? 1 : key === 'ArrowUp' ? -1 : 0;
    if (by === 0 || !(event.shiftKey || isBox(event))) return false;
    const from = this.#objectAt(event) ?? selected;
    const next = all[from === null ? 0 : Math.min(Math.max(all.indexOf(from) + by, 0), all.length - 1)];
    if (next === undefined) return false;
    if (event.shiftKey) {
      // From the row with the focus, unless the selection goes on from there.
      if (among === null) this.#anchor = from;
      this.#extendTo(next);
    }
    this.#focusOn(next);
    return true;
  }

  #click(event: MouseEvent): void {
    const id = this.#objectAt(event);
    if (id === null) return;
    if (!isExtending(event)) {
      if (isBox(event)) event.stopPropagation(); // it changes
      else this.#anchor = id;
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    // A box that was clicked is put back first.
    setTimeout(() => {
      if (event.shiftKey) this.#extendTo(id);
      else this.#toggle(id);
      this.#focusOn(id);
    });
  }

  #toggle(id: number): void {
    const now = this.chosen;
    this.#anchor = id;
    this.choose(now.includes(id) ? now.filter((other) => other !== id) : [...now, id]);
  }

  #extendTo(id: number): void {
    const all = this.all;
    this.#anchor = all.find((one) => one === this.#anchor) ?? this.#store.get().look.selected ?? id;
    const [from, to] = [all.indexOf(this.#anchor), all.indexOf(id)];
    this.choose(all.slice(Math.max(0, Math.min(from, to)), Math.max(from, to) + 1), id);
  }

  #focusOn(id: number): void {
    const box = this.#list.querySelector<HTMLElement>(`[data-mask="${id}"] [data-action=choose]`);
    box?.focus();
    box?.closest('li')?.scrollIntoView({ block: 'nearest' });
  }

  /** The object whose row has the target of the event, and not its actions. */
  #objectAt({ target }: Event): number | null {
    const row = target instanceof Element && target.closest('.motion-actions') === null ? target.closest<HTMLElement>('[data-mask]') : null;
    const id = Number(row?.dataset.mask ?? 0);
    return this.all.includes(id) ? id : null;
  }
}

function isBox({ target }: Event): boolean {
  return target instanceof HTMLElement && target.dataset.action === 'choose';
}

function isExtending({ shiftKey, ctrlKey, metaKey }: MouseEvent): boolean {
  return shiftKey || ctrlKey || metaKey;
}
