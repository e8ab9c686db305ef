//! The keyboard shortcuts as data. `keys.ts` handles and lists them.

import { strings } from '../common/strings.js';
import { ZOOM_STEP } from '../drawing/viewport.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { toggleBlinking } from './blink.js';
import { showKind } from './look.js';
import { stepOne } from './timeline.js';
import { changeRadius, chooseTool } from './tools.js';
import type { Zoom } from './zoom.js';

export interface Key {
  /** Values of `KeyboardEvent.key` in lower case, all with the same effect. */
  readonly keys: readonly string[];
  /** As shown in the list. */
  readonly shown: string;
  readonly does: string;
  readonly run: () => void;
  /** With Ctrl or the command key. */
  readonly command?: boolean;
  /** Requires Shift (true) or excludes it (false). */
  readonly shift?: boolean;
  /** An arrow key: only while the picture is enlarged, and if the focused element does not use arrow keys. */
  readonly arrows?: boolean;
}

/** How far an arrow key pans the enlarged picture, share of the view. */
const PAN = 0.1;

export function keysFor(store: Store, session: Session, zoom: Zoom): readonly Key[] {
  const { look } = strings.keys;
  const toggle = (name: 'outlines' | 'arrows' | 'residual') => () => store.look({ [name]: !store.get().look[name] });
  const pan = (right: number, down: number) => () => zoom.pan(right * PAN, down * PAN);
  return [
    { keys: ['n'], shown: 'N', does: look.blink, run: () => toggleBlinking(store) },
    { keys: ['s'], shown: 'S', does: look.split, run: () => store.look({ view: store.get().look.view === 'split' ? 'first' : 'split', blinking: false }) },
    { keys: ['g'], shown: 'G', does: look.kind, run: () => showKind(store, store.get().look.kind === 'groups' ? 'motions' : 'groups') },
    { keys: ['o'], shown: 'O', does: look.outlines, run: toggle('outlines') },
    { keys: ['a'], shown: 'A', does: look.arrows, run: toggle('arrows') },
    { keys: ['r'], shown: 'R', does: look.residual, run: toggle('residual') },
    { keys: ['+', '='], shown: '+', does: look.zoomIn, run: () => zoom.by(ZOOM_STEP) },
    { keys: ['-', '_'], shown: '−', does: look.zoomOut, run: () => zoom.by(1 / ZOOM_STEP) },
    { keys: ['0'], shown: '0', does: look.whole, run: () => zoom.whole() },
    { keys: ['1'], shown: '1', does: look.actual, run: () => zoom.actual() },
    { keys: ['arrowleft'], shown: '←', does: look.pan, run: pan(1, 0), arrows: true },
    { keys: ['arrowright'], shown: '→', does: '', run: pan(-1, 0), arrows: true },
    { keys: ['arrowup'], shown: '↑', does: '', run: pan(0, 1), arrows: true },
    { keys: ['arrowdown'], shown: '↓', does: '', run: pan(0, -1), arrows: true },
    { keys: [','], shown: ',', does: look.stepBack, run: () => stepOne(store, session, 'both', -1) },
    { keys: ['.'], shown: '.', does: look.stepOn, run: () => stepOne(store, session, 'both', 1) },
    { keys: ['v'], shown: 'V', does: look.look, run: () => chooseTool(store, 'look') },
    { keys: ['p'], shown: 'P', does: look.brush, run: () => chooseTool(store, 'brush') },
    { keys: ['e'], shown: 'E', does: look.eraser, run: () => chooseTool(store, 'eraser') },
    { keys: [], shown: 'Space', does: look.stroke, run: () => undefined },
    { keys: ['['], shown: '[', does: look.thinner, run: () => changeRadius(store, 0.75) },
    { keys: [']'], shown: ']', does: look.thicker, run: () => changeRadius(store, 4 / 3) },
    { keys: ['z'], shown: 'Ctrl Z', does: look.undo, run: () => session.correcting.undo(), command: true, shift: false },
    { keys: ['z'], shown: 'Ctrl Shift Z', does: look.redo, run: () => session.correcting.redo(), command: true, shift: true },
    { keys: ['y'], shown: 'Ctrl Y', does: '', run: () => session.correcting.redo(), command: true },
    { keys: ['escape'], shown: 'Esc', does: look.cancel, run: () => session.cancel() },
  ];
}
