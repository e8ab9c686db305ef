//! The keyboard shortcuts as data. `keys.ts` handles them, `key-list.ts` says what they do.

import { ZOOM_STEP } from '../drawing/viewport.js';
import type { Session } from '../session/session.js';
import { type Store, type ToolName, selectedIn } from '../state/state.js';
import { livesOf } from '../state/tracked.js';
import { toggleBlinking } from './blink.js';
import { isReached, takesArrows, takesSpace } from './focused.js';
import { renameSelected } from './renaming.js';
import { toggleMotions } from './inspect.js';
import { setEdge } from './range.js';
import { FAR } from './timeline.js';
import { accept } from './review.js';
import { changeRadius, chooseTool } from './tools.js';
import type { Zoom } from './zoom.js';

export interface Key {
  /** Values of `KeyboardEvent.key` in lower case, all with the same effect. */
  readonly keys: readonly string[];
  /** Takes the key that was pressed, in lower case. */
  readonly run: (name: string) => void;
  /** With Ctrl or the command key. */
  readonly command?: boolean;
  /** Requires Shift (true) or excludes it (false). */
  readonly shift?: boolean;
  /** Whether it has an effect now, where the focus is. Else the key is that of others. */
  readonly when?: (target: EventTarget | null) => boolean;
}

const NUMBERS = ['1', '2', '3', '4', '5', '6', '7', '8', '9'];
/** How far an arrow key pans the enlarged picture, share of the view. */
const PAN = 0.1;

export function keysFor(store: Store, session: Session, zoom: Zoom): readonly Key[] {
  const toggle = (name: 'outlines' | 'onion') => () => store.look({ [name]: !store.get().look[name] });
  const pan = (right: number, down: number) => () => zoom.pan(right * PAN, down * PAN);
  const step = (by: number) => () => void session.frames.step(by);
  const tool = (name: ToolName) => () => chooseTool(store, name);
  const inClip = (): boolean => store.get().timeline !== null;
  const steps = (target: EventTarget | null): boolean => inClip() && !takesArrows(target) && !(isReached(target, '.layers') && store.get().viewport.zoom > 1);
  const pans = (target: EventTarget | null): boolean => store.get().viewport.zoom > 1 && !takesArrows(target);
  const plays = (target: EventTarget | null): boolean => inClip() && !takesSpace(target);
  return [
    { keys: ['arrowright'], run: step(1), shift: false, when: steps },
    { keys: ['.'], run: step(1) },
    { keys: ['arrowleft'], run: step(-1), shift: false, when: steps },
    { keys: [','], run: step(-1) },
    { keys: ['arrowright'], run: step(FAR), shift: true, when: steps },
    { keys: ['arrowleft'], run: step(-FAR), shift: true, when: steps },
    { keys: [' '], run: () => void session.play.toggle(), when: plays },
    { keys: ['k'], run: () => void session.play.toggle() },
    { keys: ['j'], run: () => session.play.change(-1), shift: false },
    { keys: ['j'], run: () => session.play.change(1), shift: true },
    { keys: ['i'], run: () => setEdge(store, session, 'first') },
    { keys: ['o'], run: () => setEdge(store, session, 'last') },
    { keys: ['d'], run: () => session.frames.goToDoubtful(), shift: false },
    { keys: ['d'], run: () => session.frames.goToDoubtful(null, -1), shift: true },
    { keys: ['n'], run: () => session.frames.goToChanged() },
    { keys: ['c'], run: () => session.frames.goToCorrected(1), shift: false },
    { keys: ['c'], run: () => session.frames.goToCorrected(-1), shift: true },
    { keys: ['y'], run: () => accept(session, 'shown'), shift: false },
    { keys: ['y'], run: () => accept(session, 'all'), shift: true },
    { keys: ['v'], run: tool('look') },
    { keys: ['b', 'p'], run: tool('brush') },
    { keys: ['e'], run: tool('eraser') },
    { keys: ['w'], run: tool('polygon') },
    { keys: ['x'], run: () => chooseBox(store) },
    { keys: ['['], run: () => changeRadius(store, 0.75) },
    { keys: [']'], run: () => changeRadius(store, 4 / 3) },
    { keys: ['q'], run: () => store.set({ tool: { ...store.get().tool, exact: !store.get().tool.exact } }) },
    { keys: ['z'], run: () => session.undo(), command: true, shift: false },
    { keys: ['z'], run: () => session.redo(), command: true, shift: true },
    { keys: ['y'], run: () => session.redo(), command: true },
    { keys: ['escape'], run: () => session.cancel() },
    { keys: NUMBERS, run: (name) => selectMask(store, session, Number(name)) },
    { keys: ['f2'], run: renameSelected },
    { keys: ['t'], run: toClass },
    { keys: ['l'], run: () => session.objects.toggleLock(...chosen(store)), shift: true },
    { keys: ['delete'], run: () => session.objects.remove(...chosen(store)) },
    // With a polygon it takes corners back; one press too many deletes nothing.
    { keys: ['backspace'], run: () => session.objects.remove(...chosen(store)), when: () => store.get().tool.name !== 'polygon' },
    { keys: ['>'], run: () => void copyMask(session, 1) },
    { keys: ['<'], run: () => void copyMask(session, -1) },
    { keys: ['f'], run: () => toggleBlinking(store), shift: true },
    { keys: ['s'], run: () => store.look({ view: store.get().look.view === 'split' ? 'first' : 'split', blinking: false }) },
    { keys: ['g'], run: () => toggleMotions(store) },
    { keys: ['l'], run: toggle('outlines'), shift: false },
    { keys: ['u'], run: toggle('onion') },
    { keys: ['+', '='], run: () => zoom.by(ZOOM_STEP) },
    { keys: ['-', '_'], run: () => zoom.by(1 / ZOOM_STEP) },
    { keys: ['0'], run: () => zoom.whole() },
    { keys: ['z'], run: () => zoom.actual() },
    { keys: ['arrowleft'], run: pan(1, 0), when: pans },
    { keys: ['arrowright'], run: pan(-1, 0), when: pans },
    { keys: ['arrowup'], run: pan(0, 1), when: pans },
    { keys: ['arrowdown'], run: pan(0, -1), when: pans },
  ];
}

/** Selects the object with this place in the list, after the background. */
function selectMask(store: Store, session: Session, place: number): void {
  const { tracked } = store.get();
  const life = tracked === null ? undefined : livesOf(tracked)[place - 1];
  if (life !== undefined) session.shown.select(life.id);
}

/** The objects that are selected. */
function chosen(store: Store): number[] {
  return selectedIn(store.get().look).filter((id) => id !== 0);
}

/** Goes to the class of what is selected. */
function toClass(): void {
  document.querySelector<HTMLElement>(':is(#several, #objects:not(.choosing) .selected) .class')?.focus();
}

/** Chooses the box; if it is chosen, what a press is next. */
function chooseBox(store: Store): void {
  if (store.get().tool.name !== 'box') return chooseTool(store, 'box');
  const choices = [...document.querySelectorAll<HTMLInputElement>('[name=pointing]:enabled')];
  choices[(choices.findIndex(({ checked }) => checked) + 1) % choices.length]?.click();
}

/** Copies the selected mask to a neighbouring frame and goes there. */
async function copyMask(session: Session, by: 1 | -1): Promise<void> {
  const to = await session.objects.copyMask(by);
  if (to !== null) void session.frames.goTo(to);
}
