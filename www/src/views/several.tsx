//! What can be done with several objects together.

import { type VNode, render } from 'preact';
import { useLayoutEffect } from 'preact/hooks';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { isReady, lockedIn, objectsOf } from '../state/tracked.js';
import { ClassField } from './class-field.js';
import { usePart } from './component.js';
import { find } from './markup.js';
import { Selecting } from './selecting.js';

export function mountSeveral(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#objects', HTMLOListElement);
  const toggle = find(root, '#select-several', HTMLButtonElement);
  const bar = find(root, '#several', HTMLElement);
  const selecting = new Selecting(list, store, session);
  toggle.addEventListener('click', () => (store.get().look.among === null ? selecting.choose(selecting.chosen) : selecting.end()));
  list.closest('section')!.addEventListener('keydown', (event) => {
    if (!selecting.key(event, toggle)) return;
    event.preventDefault();
    event.stopPropagation();
  });
  store.subscribe(({ look: { among }, tracked }, before) => {
    if (among === before.look.among && tracked === before.tracked) return;
    toggle.setAttribute('aria-pressed', String(among !== null));
    // Those that are gone leave the selection.
    const { chosen } = selecting;
    if (among !== null && tracked !== null && chosen.length < among.size) selecting.choose(chosen);
  });
  render(<Several root={bar} list={list} selecting={selecting} store={store} session={session} />, bar);
}

interface Given {
  readonly root: HTMLElement;
  readonly list: HTMLElement;
  readonly selecting: Selecting;
  readonly store: Store;
  readonly session: Session;
}

function Several({ root, list, selecting, store, session }: Given): VNode {
  const among = usePart(store, ({ look }) => look.among);
  const tracked = usePart(store, (state) => state.tracked);
  useLayoutEffect(() => void (root.hidden = among === null), [among]);
  const ids = among === null ? [] : selecting.chosen;
  const [locked, entries] = [lockedIn(tracked ?? { objects: [] }), objectsOf(tracked ?? { objects: [] })];
  const classes = new Set(ids.map((id) => entries.get(id)?.class ?? ''));
  const cannot = !isReady(tracked) || ids.length === 0;

  const merge = (): void => {
    selecting.end(ids[0]);
    session.objects.merge(...ids);
    list.querySelector<HTMLElement>(`[data-mask="${ids[0]}"] summary`)?.focus({ preventScroll: true });
  };
  const remove = (): void => {
    selecting.end(null);
    session.objects.remove(...ids);
    list.focus({ preventScroll: true });
  };
  const exportThem = (): void => {
    selecting.end();
    store.look({ hidden: new Set(selecting.all.filter((id) => !ids.includes(id))), solo: null });
    find(document, '#open-export', HTMLElement).focus();
    find(document, '#export', HTMLElement).showPopover();
  };
  return (
    <>
      <span role="status">{among === null ? '' : strings.selected(ids.length)}</span>
      <ClassField
        value={classes.size === 1 ? [...classes][0]! : ''}
        label="Class of the selected objects"
        disabled={ids.length === 0}
        take={(name) => session.objects.setClasses(new Map(ids.map((id) => [id, name])))}
      />
      <button type="button" class="button small quiet" data-action="merge" disabled={cannot || ids.length < 2} onClick={merge}>
        Merge
      </button>
      <button type="button" class="button small quiet" data-action="remove" disabled={cannot} onClick={remove}>
        Delete
      </button>
      <button
        type="button"
        class="button small quiet"
        data-action="lock"
        aria-pressed={ids.length > 0 && ids.every((id) => locked.has(id))}
        disabled={cannot}
        onClick={() => session.objects.toggleLock(...ids)}
      >
        Lock
      </button>
      <button type="button" class="button small quiet" data-action="export" title="Tick these alone, and export them" disabled={cannot} onClick={exportThem}>
        Export
      </button>
    </>
  );
}
