//! Selecting several objects of a clip, and what can be done with them together.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import { type State, type Store, selectedIn } from '../state/state.js';
import { isReady, livesOf, lockedIn, objectsOf } from '../state/tracked.js';
import { onClass } from './classes.js';
import { takesText } from './focused.js';
import { find } from './markup.js';

export function mountSeveral(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#objects', HTMLOListElement);
  const toggle = find(root, '#select-several', HTMLButtonElement);
  const bar = find(root, '#several', HTMLElement);
  const status = find(bar, '[role=status]', HTMLElement);
  const button = (action: string): HTMLButtonElement => find(bar, `[data-action=${action}]`, HTMLButtonElement);
  const [merge, lock] = [button('merge'), button('lock')];
  const actions = [lock, button('remove'), button('export')];
  const field = find(bar, '.class', HTMLInputElement);
  /** From where Shift extends. */
  let anchor: number | null = null;

  /** The objects in their order. */
  const objects = (): number[] => livesOf(store.get().tracked ?? { frames: [] }).map(({ id }) => id);
  const chosen = (): number[] => {
    const among = selectedIn(store.get().look);
    return objects().filter((id) => among.includes(id));
  };
  const choose = (ids: readonly number[], selected = ids.at(-1) ?? null): void => store.look({ among: new Set(ids), selected });
  const end = (selected = store.get().look.selected): void => session.shown.select(selected);

  const toggleOne = (id: number): void => {
    const now = chosen();
    anchor = id;
    choose(now.includes(id) ? now.filter((other) => other !== id) : [...now, id]);
  };
  const extendTo = (id: number): void => {
    const all = objects();
    anchor = all.find((one) => one === anchor) ?? store.get().look.selected ?? id;
    const [from, to] = [all.indexOf(anchor), all.indexOf(id)];
    choose(all.slice(Math.max(0, Math.min(from, to)), Math.max(from, to) + 1), id);
  };
  const focusOn = (id: number): void => {
    const box = list.querySelector<HTMLElement>(`[data-mask="${id}"] [data-action=choose]`);
    box?.focus();
    box?.closest('li')?.scrollIntoView({ block: 'nearest' });
  };

  /** The object whose row has the target of the event, and not its actions. */
  const objectAt = ({ target }: Event): number | null => {
    const row = target instanceof Element && target.closest('.motion-actions') === null ? target.closest<HTMLElement>('[data-mask]') : null;
    const id = Number(row?.dataset.mask ?? 0);
    return objects().includes(id) ? id : null;
  };
  const isBox = ({ target }: Event): boolean => target instanceof HTMLElement && target.dataset.action === 'choose';
  const isExtending = ({ shiftKey, ctrlKey, metaKey }: MouseEvent): boolean => shiftKey || ctrlKey || metaKey;
  list.addEventListener('mousedown', (event) => {
    if (isExtending(event) && objectAt(event) !== null) event.preventDefault(); // neither a focus nor selected text
  });
  // Before the row selects itself alone.
  list.addEventListener(
    'click',
    (event) => {
      const id = objectAt(event);
      if (id === null) return;
      if (!isExtending(event)) {
        if (isBox(event)) event.stopPropagation(); // it changes
        else anchor = id;
        return;
      }
      event.preventDefault();
      event.stopPropagation();
      // A box that was clicked is put back first.
      setTimeout(() => {
        (event.shiftKey ? extendTo : toggleOne)(id);
        focusOn(id);
      });
    },
    true,
  );
  list.addEventListener('change', (event) => {
    const id = isBox(event) ? objectAt(event) : null;
    if (id !== null) toggleOne(id);
  });
  list.addEventListener('focusin', (event) => {
    if (store.get().look.among !== null) event.stopPropagation();
  }, true);

  const section = list.closest('section')!;
  section.addEventListener('keydown', (event) => {
    const { key, target } = event;
    if (takesText(target) || event.altKey || !(target instanceof Node)) return;
    const command = event.ctrlKey || event.metaKey;
    const by = command ? 0 : key === 'ArrowDown' ? 1 : key === 'ArrowUp' ? -1 : 0;
    const all = objects();
    if (key === 'Escape' && store.get().look.among !== null) {
      end();
      toggle.focus();
    } else if (!list.contains(target)) return;
    else if (command && key.toLowerCase() === 'a') choose(all);
    else if (by !== 0 && (event.shiftKey || isBox(event))) {
      const from = objectAt(event) ?? store.get().look.selected;
      const next = all[from === null ? 0 : Math.min(Math.max(all.indexOf(from) + by, 0), all.length - 1)];
      if (next === undefined) return;
      if (event.shiftKey) {
        // From the row with the focus, unless the selection goes on from there.
        if (store.get().look.among === null) anchor = from;
        extendTo(next);
      }
      focusOn(next);
    } else return;
    event.preventDefault();
    event.stopPropagation();
  });

  toggle.addEventListener('click', () => (store.get().look.among === null ? choose(chosen()) : end()));
  merge.addEventListener('click', () => {
    const ids = chosen();
    end(ids[0]);
    session.objects.merge(...ids);
    list.querySelector<HTMLElement>(`[data-mask="${ids[0]}"] summary`)?.focus({ preventScroll: true });
  });
  button('remove').addEventListener('click', () => {
    const ids = chosen();
    end(null);
    session.objects.remove(...ids);
    list.focus({ preventScroll: true });
  });
  lock.addEventListener('click', () => session.objects.toggleLock(...chosen()));
  button('export').addEventListener('click', () => {
    const ids = chosen();
    end();
    store.look({ hidden: new Set(objects().filter((id) => !ids.includes(id))), solo: null });
    find(document, '#open-export', HTMLElement).focus();
    find(document, '#export', HTMLElement).showPopover();
  });
  onClass(field, (name) => session.objects.setClasses(new Map(chosen().map((id) => [id, name]))));

  const render = ({ look, tracked }: State): void => {
    const { among } = look;
    const on = among !== null;
    list.classList.toggle('choosing', on);
    toggle.setAttribute('aria-pressed', String(on));
    bar.hidden = !on;
    if (tracked === null) return;
    const all = objects();
    for (const row of list.querySelectorAll<HTMLElement>(':scope > li')) {
      const id = Number(row.dataset.mask);
      const box = find(row, '[data-action=choose]', HTMLInputElement);
      box.hidden = id === 0;
      box.disabled = !all.includes(id);
      box.checked = on && among.has(id);
      box.setAttribute('aria-label', strings.selectObject(nameOf(look, id)));
      row.classList.toggle('chosen', box.checked);
    }
    if (!on) return;
    const ids = chosen();
    // Those that are gone leave the selection.
    if (ids.length < among.size) return choose(ids);
    status.textContent = strings.selected(ids.length);
    const ready = isReady(tracked);
    const [locked, entries] = [lockedIn(tracked), objectsOf(tracked)];
    merge.disabled = !ready || ids.length < 2;
    for (const control of actions) control.disabled = !ready || ids.length === 0;
    field.disabled = ids.length === 0;
    lock.setAttribute('aria-pressed', String(ids.length > 0 && ids.every((id) => locked.has(id))));
    const classes = new Set(ids.map((id) => entries.get(id)?.class ?? ''));
    if (document.activeElement !== field) field.value = classes.size === 1 ? [...classes][0]! : '';
  };
  store.subscribe((now, before) => {
    if (now.look !== before.look || now.tracked !== before.tracked) render(now);
  });
  render(store.get());
}
