//! A row of the list of objects: colour, name, class and life of one, with its actions.

import type { TargetedEvent, VNode } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { strings } from '../common/strings.js';
import { type Colour, colourFromHex, cssColour, hexColour } from '../drawing/palette.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { ClassField } from './class-field.js';
import { memo, usePart } from './component.js';
import { Icon } from './icon.js';
import { ObjectMore } from './object-more.js';
import { rename } from './renaming.js';
import { drawThumbnail } from './thumbnail.js';

interface Given {
  readonly id: number;
  readonly name: string;
  readonly colour: Colour;
  /** The frames that show it, or what to do with one that is about to be painted. */
  readonly facts: string;
  readonly class: string;
  /** The frame where it is least certain, unless a person has looked there. */
  readonly doubtful: number | null;
  readonly isShown: boolean;
  readonly isSolo: boolean;
  readonly isSelected: boolean;
  /** Whether it is selected with others. */
  readonly isChosen: boolean;
  /** Whether a frame shows it: one that is about to be painted is not known yet. */
  readonly isKnown: boolean;
  readonly isLocked: boolean;
  readonly ready: boolean;
  /** Numbers and names of all objects. */
  readonly others: readonly (readonly [number, string])[];
  readonly store: Store;
  readonly session: Session;
}

/** Whether a pointer that is down was pressed in a row. */
let isPressed = false;
const press = (): void => {
  isPressed = true;
  for (const end of ['pointerup', 'pointercancel']) window.addEventListener(end, () => (isPressed = false), { once: true, capture: true });
};

export const ObjectRow = memo(function (given: Given): VNode {
  const { id, name, isShown, isSolo, isSelected, isChosen, isKnown, isLocked, ready, store, session } = given;
  // A row that is selected has its actions elsewhere, and another one that was loses its own: nothing may move away from a pointer that is down.
  const select = ({ target }: Event): void => {
    if (!isPressed && (!(target instanceof Element) || target.closest('.motion-actions') === null)) session.shown.select(id);
  };
  // At once, because a key may come next; a box that was clicked has to change before.
  const click = (event: Event): void => {
    const isBox = event.target instanceof HTMLInputElement && event.target.type === 'checkbox';
    return isBox ? void setTimeout(() => select(event)) : select(event);
  };
  const show = (on: boolean): void => {
    const hidden = new Set(store.get().look.hidden);
    if (on) hidden.delete(id);
    else hidden.add(id);
    store.look({ hidden, solo: null });
  };
  const isObject = id !== 0;
  return (
    <li
      class={`motion${isShown ? '' : ' away'}${isSelected ? ' selected' : ''}${isChosen ? ' chosen' : ''}`}
      data-mask={id}
      style={{ '--colour': cssColour(given.colour) }}
      onPointerDown={press}
      onFocusIn={select}
      onClick={click}
    >
      <div class="motion-head">
        <input type="checkbox" data-action="choose" checked={isChosen} hidden={!isObject} disabled={!isKnown} aria-label={strings.selectObject(name)} />
        {/* The background cannot be hidden: it is not painted. */}
        <input type="checkbox" data-action="show" checked={isShown} hidden={!isObject} aria-label={strings.show(name)} onChange={({ currentTarget }) => show(currentTarget.checked)} />
        {isObject && <Thumbnail id={id} store={store} />}
        {isObject && <Swatch {...given} />}
        <Name id={id} name={name} session={session} />
        <Share id={id} store={store} />
      </div>
      {isObject && <Facts {...given} />}
      {isObject && (
        <div class="motion-actions">
          <button
            type="button"
            class="button small quiet"
            data-action="solo"
            aria-pressed={isSolo}
            aria-label={strings.soloOf(name)}
            title="Show this one alone"
            onClick={() => store.look({ solo: isSolo ? null : id })}
          >
            <Icon path="M10 4.5a5.5 5.5 0 1 1 0 11 5.5 5.5 0 0 1 0-11zM10 9v2" size={16} />
            <span>Solo</span>
          </button>
          <button
            type="button"
            class="button small quiet"
            data-action="lock"
            aria-pressed={isLocked}
            aria-label={strings.lockOf(name)}
            title="Nothing changes this object until it is unlocked"
            disabled={!ready || !isKnown}
            onClick={() => session.objects.toggleLock(id)}
          >
            <Icon path="M5 9h10v7H5zM7 9V6.5a3 3 0 0 1 6 0V9" size={16} />
            <span>Lock</span>
          </button>
          <ClassField value={given.class} label={strings.classOf(name)} title="Class (T)" take={(named) => session.objects.setClasses(new Map([[id, named]]))} />
          <Doubtful id={id} name={name} index={given.doubtful} session={session} />
          <ObjectMore id={id} name={name} ready={ready && isKnown} others={given.others} store={store} session={session} />
        </div>
      )}
    </li>
  );
});

/** How much of the frame it covers. What is about the frame on screen renders by itself, so that a step through frames renders no rows. */
function Share({ id, store }: Pick<Given, 'id' | 'store'>): VNode {
  const share = usePart(store, ({ result }) => {
    const pixels = id === 0 ? result?.masks.rest : result?.masks.objects.find((object) => object.id === id)?.pixels;
    return result === null || pixels === undefined ? '' : strings.percent(pixels / result.masks.labels.length);
  });
  return <span class="motion-share">{share}</span>;
}

function Facts({ id, facts, isKnown, store }: Given): VNode {
  const isAway = usePart(store, ({ result }) => result !== null && result.masks.objects.every((object) => object.id !== id));
  return <p class="motion-facts faint">{isKnown && isAway ? `${facts} · ${strings.away}` : facts}</p>;
}

/** Its part of the frame. Where it is not in sight, it looks as it did. */
function Thumbnail({ id, store }: Pick<Given, 'id' | 'store'>): VNode {
  const result = usePart(store, (state) => state.result);
  const canvas = useRef<HTMLCanvasElement>(null);
  useLayoutEffect(() => {
    const here = result?.masks.objects.find((object) => object.id === id);
    if (here !== undefined) drawThumbnail(canvas.current!, result!.frame, here.bbox);
  }, [result]);
  return <canvas ref={canvas} class="thumbnail" width="72" height="56" aria-hidden="true" />;
}

/** Colours that are passed while one is looked for are one step of undo. */
function Swatch({ id, name, colour, session }: Given): VNode {
  const isPicking = useRef(false);
  const take = ({ currentTarget }: TargetedEvent<HTMLInputElement>): void => {
    session.objects.setAppearance(id, { colour: colourFromHex(currentTarget.value) }, isPicking.current);
    isPicking.current = true;
  };
  return (
    <input
      type="color"
      class="swatch"
      data-action="colour"
      value={hexColour(colour)}
      aria-label={strings.colourOf(name)}
      onInput={take}
      onChange={() => (isPicking.current = false)}
    />
  );
}

/** The name, which is typed once it is asked for. */
function Name({ id, name, session }: Pick<Given, 'id' | 'name' | 'session'>): VNode {
  const field = useRef<HTMLInputElement>(null);
  useLayoutEffect(() => {
    if (field.current!.readOnly) field.current!.value = name;
  });
  const key = (event: TargetedEvent<HTMLInputElement, KeyboardEvent>): void => {
    const { currentTarget: input } = event;
    if (event.key === 'Enter' && input.readOnly) return rename(input);
    if (event.key === 'Escape' && !input.readOnly) input.value = name;
    else if (event.key !== 'Enter') return;
    input.blur();
  };
  return (
    <input
      ref={field}
      type="text"
      class="motion-name"
      readOnly
      aria-label={strings.nameOf(name)}
      title="Double-click to rename (F2)"
      maxLength={40}
      spellcheck={false}
      autocomplete="off"
      onChange={({ currentTarget }) => session.objects.setAppearance(id, { name: currentTarget.value.trim() })}
      onBlur={({ currentTarget }) => {
        currentTarget.readOnly = true;
        currentTarget.value = name;
      }}
      onKeyDown={key}
    />
  );
}

/** Goes to the frame where it is least certain. */
function Doubtful({ id, name, index, session }: Pick<Given, 'id' | 'name' | 'session'> & { readonly index: number | null }): VNode {
  const label = index === null ? '' : strings.doubtfulOf(name, index);
  const go = (): void => {
    session.frames.goToDoubtful(id);
    document.querySelector<HTMLElement>('.layers')?.focus({ preventScroll: true }); // the button has gone
  };
  return (
    <button type="button" class="button small quiet" data-action="doubtful" hidden={index === null} aria-label={label} title={label} onClick={go}>
      {index === null ? '' : strings.doubtful(index)}
    </button>
  );
}
