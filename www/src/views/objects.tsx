//! The list of a clip's objects, which is the same in every frame, and what is below it.

import { type VNode, render } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask, isShown } from '../drawing/paint.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { type Life, type Tracked, isDrafting, isObject, isReady, isSeen, livesOf, lockedIn, objectsOf, shownFrames } from '../state/tracked.js';
import { usePart } from './component.js';
import { find } from './markup.js';
import { ObjectRow } from './object-row.js';
import { chooseTool } from './tools.js';

interface Given {
  readonly store: Store;
  readonly session: Session;
}

export function mountObjects(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#objects', HTMLOListElement);
  render(<Objects list={list} store={store} session={session} />, list);
  const empty = find(root, '#motions-empty', HTMLElement);
  render(<Nothing root={empty} store={store} />, empty);
  const add = find(root, '#add-object', HTMLButtonElement);
  add.addEventListener('click', () => {
    if (session.objects.addObject()) chooseTool(store, 'brush');
  });
  store.subscribe(({ tracked }, before) => {
    if (tracked === before.tracked) return;
    add.parentElement!.hidden = !isSeen(tracked);
    add.disabled = !isReady(tracked);
  });
}

/** What stands where the list will be. */
function Nothing({ root, store }: { root: HTMLElement; store: Store }): VNode {
  const isHidden = usePart(store, ({ tracked }) => isSeen(tracked));
  const sentence = usePart(store, ({ live, result }) => (live === null ? strings.noMasksYet : strings.liveMasks(result?.second?.objects.length ?? 0)));
  useLayoutEffect(() => void (root.hidden = isHidden), [isHidden]);
  return <>{sentence}</>;
}

function Objects({ list, store, session }: Given & { list: HTMLElement }): VNode {
  const tracked = usePart(store, (state) => state.tracked);
  const look = usePart(store, (state) => state.look);
  const seen = isSeen(tracked) ? tracked : null;
  const lives = new Map(livesOf({ frames: shownFrames(seen) }).map((life) => [life.id, life]));
  const ids = seen === null ? [] : idsOf(seen, lives, look.selected);
  const choosing = look.among !== null;

  // Which row has the focus before rows go.
  const held = heldRow(list);
  useLayoutEffect(() => {
    list.hidden = seen === null;
    list.inert = isDrafting(seen);
    list.classList.toggle('choosing', choosing);
    if (held !== null && !ids.includes(held)) list.querySelector<HTMLElement>('.selected summary')?.focus({ preventScroll: true });
  });
  useLayoutEffect(() => {
    const row = list.querySelector(`[data-mask="${look.selected}"]`);
    if (row !== null) scrollTo(list, row);
  }, [look.selected]);

  const others = useOthers(ids, look);
  if (seen === null) return <></>;
  const [entries, locked, ready] = [objectsOf(seen), lockedIn(seen), isReady(seen)];
  return (
    <>
      {ids.map((id) => {
        const life = lives.get(id);
        return (
          <ObjectRow
            key={id}
            id={id}
            name={nameOf(look, id)}
            colour={colourOfMask(id, look)}
            facts={life === undefined ? strings.newObjectHelp : strings.life(life.first, life.last)}
            class={entries.get(id)?.class ?? ''}
            doubtful={life === undefined || seen.checked.get(id) === life.doubtful.index ? null : life.doubtful.index}
            isShown={isShown(id, look)}
            isSolo={look.solo === id}
            isSelected={look.selected === id}
            isChosen={look.among?.has(id) ?? false}
            isKnown={life !== undefined}
            isLocked={locked.has(id)}
            ready={ready}
            others={others}
            store={store}
            session={session}
          />
        );
      })}
    </>
  );
}

/** The background, the objects, and one that is selected but not painted yet. */
function idsOf({ objects }: Tracked, lives: ReadonlyMap<number, Life>, selected: number | null): number[] {
  const ids = [0, ...lives.keys()];
  // Those of drafts are not among the objects of the clip yet.
  const isNew = selected !== null && isObject(selected) && !lives.has(selected) && !objects.some(({ number }) => number === selected);
  return isNew ? [...ids, selected] : ids;
}

/** Numbers and names of all objects: the same while these are. */
function useOthers(ids: readonly number[], look: State['look']): readonly (readonly [number, string])[] {
  const known = useRef<readonly (readonly [number, string])[]>([]);
  const now = ids.filter((id) => id !== 0).map((id) => [id, nameOf(look, id)] as const);
  if (now.join() !== known.current.join()) known.current = now;
  return known.current;
}

/** The object whose row has the focus. */
function heldRow(list: HTMLElement): number | null {
  const row = list.contains(document.activeElement) ? document.activeElement!.closest<HTMLElement>('[data-mask]') : null;
  return row === null ? null : Number(row.dataset.mask);
}

/** Scrolls a list that scrolls by itself, and nothing around it, until a row is in sight. */
function scrollTo(list: HTMLElement, row: Element): void {
  const [inner, outer] = [row.getBoundingClientRect(), list.getBoundingClientRect()];
  if (inner.top < outer.top || inner.height > outer.height) list.scrollTop += inner.top - outer.top;
  else if (inner.bottom > outer.bottom) list.scrollTop += inner.bottom - outer.bottom;
}
