//! The keyboard shortcuts as data. `keys.ts` handles and lists them.

import { ZOOM_STEP } from '../drawing/viewport.js';
import { masksOf } from '../result/masks.js';
import type { Session } from '../session/session.js';
import { type Store, type ToolName, selectedIn } from '../state/state.js';
import { livesOf } from '../state/tracked.js';
import { toggleBlinking } from './blink.js';
import { isReached, takesArrows, takesSpace } from './focused.js';
import { renameSelected } from './mask-row.js';
import { setEdge } from './range.js';
import { FAR, stepOne } from './timeline.js';
import { accept } from './review.js';
import { changeRadius, chooseTool } from './tools.js';
import type { Zoom } from './zoom.js';

export interface Key {
  /** Values of `KeyboardEvent.key` in lower case, all with the same effect. */
  readonly keys: readonly string[];
  /** As shown in the list. */
  readonly shown: string;
  /** Its effect in words; empty if that is the one of the key before it. */
  readonly does: string;
  /** Takes the key that was pressed, in lower case. */
  readonly run: (name: string) => void;
  /** With Ctrl or the command key. */
  readonly command?: boolean;
  /** Requires Shift (true) or excludes it (false). */
  readonly shift?: boolean;
  /** Whether it has an effect now, where the focus is. Else the key is that of others. */
  readonly when?: (target: EventTarget | null) => boolean;
}

/** Keys about one thing. */
export interface Group {
  readonly title: string;
  readonly keys: readonly Key[];
}

const NUMBERS = ['1', '2', '3', '4', '5', '6', '7', '8', '9'];
/** How far an arrow key pans the enlarged picture, share of the view. */
const PAN = 0.1;

export function keysFor(store: Store, session: Session, zoom: Zoom): readonly Group[] {
  const toggle = (name: 'outlines' | 'onion' | 'arrows' | 'residual') => () => store.look({ [name]: !store.get().look[name] });
  const pan = (right: number, down: number) => () => zoom.pan(right * PAN, down * PAN);
  const step = (by: number) => () => stepOne(store, session, 'both', by);
  const tool = (name: ToolName) => () => chooseTool(store, name);
  const inClip = (): boolean => store.get().timeline !== null;
  const steps = (target: EventTarget | null): boolean => inClip() && !takesArrows(target) && !(isReached(target, '.layers') && store.get().viewport.zoom > 1);
  const pans = (target: EventTarget | null): boolean => store.get().viewport.zoom > 1 && !takesArrows(target);
  const plays = (target: EventTarget | null): boolean => inClip() && !takesSpace(target);
  return [
    {
      title: 'Frames',
      keys: [
        { keys: ['arrowright'], shown: '→', does: 'Step forward', run: step(1), shift: false, when: steps },
        { keys: ['.'], shown: '.', does: '', run: step(1) },
        { keys: ['arrowleft'], shown: '←', does: 'Step back', run: step(-1), shift: false, when: steps },
        { keys: [','], shown: ',', does: '', run: step(-1) },
        { keys: ['arrowright'], shown: 'Shift →', does: 'Step ten frames forward, or back', run: step(FAR), shift: true, when: steps },
        { keys: ['arrowleft'], shown: 'Shift ←', does: '', run: step(-FAR), shift: true, when: steps },
        { keys: [' '], shown: 'Space', does: 'Play the clip, or stop', run: () => void session.play.toggle(), when: plays },
        { keys: ['k'], shown: 'K', does: '', run: () => void session.play.toggle() },
        { keys: ['j'], shown: 'J', does: 'Play slower', run: () => session.play.change(-1), shift: false },
        { keys: ['j'], shown: 'Shift J', does: 'Play faster', run: () => session.play.change(1), shift: true },
        { keys: ['i'], shown: 'I', does: 'In point: segment the clip from this frame on', run: () => setEdge(store, session, 'first') },
        { keys: ['o'], shown: 'O', does: 'Out point: segment the clip up to this frame', run: () => setEdge(store, session, 'last') },
      ],
    },
    {
      title: 'Review',
      keys: [
        { keys: ['d'], shown: 'D', does: 'Next frame where an object is least certain', run: () => session.frames.goToDoubtful(), shift: false },
        { keys: ['d'], shown: 'Shift D', does: 'Previous frame where an object is least certain', run: () => session.frames.goToDoubtful(null, -1), shift: true },
        { keys: ['n'], shown: 'N', does: 'Frame that the last correction changed most; again, the next one', run: () => session.frames.goToChanged() },
        { keys: ['c'], shown: 'C', does: 'Next corrected frame', run: () => session.frames.goToCorrected(1), shift: false },
        { keys: ['c'], shown: 'Shift C', does: 'Previous corrected frame', run: () => session.frames.goToCorrected(-1), shift: true },
        { keys: ['y'], shown: 'Y', does: 'Accept the masks of this frame, and go to the frame that most needs a look', run: () => accept(session, 'shown'), shift: false },
        { keys: ['y'], shown: 'Shift Y', does: 'Accept the masks of all frames', run: () => accept(session, 'all'), shift: true },
      ],
    },
    {
      title: 'Tools',
      keys: [
        { keys: ['v'], shown: 'V', does: 'View: select masks, pan', run: tool('look') },
        { keys: ['b', 'p'], shown: 'B', does: 'Brush: add to the selected mask', run: tool('brush') },
        { keys: ['e'], shown: 'E', does: 'Eraser: remove from the selected mask', run: tool('eraser') },
        { keys: ['w'], shown: 'W', does: 'Polygon: add its inside to the selected mask; Enter closes it, with Shift to remove, Backspace takes a corner back', run: tool('polygon') },
        { keys: ['x'], shown: 'X', does: 'Box: make a new object of a clip; again, add to the selected one or remove from it, as a press with Shift or Alt does', run: () => chooseBox(store) },
        { keys: ['['], shown: '[', does: 'Smaller brush', run: () => changeRadius(store, 0.75) },
        { keys: [']'], shown: ']', does: 'Larger brush', run: () => changeRadius(store, 4 / 3) },
        { keys: ['q'], shown: 'Q', does: 'Exact: what is drawn is kept pixel for pixel, and nothing follows', run: () => store.set({ tool: { ...store.get().tool, exact: !store.get().tool.exact } }) },
        { keys: ['z'], shown: 'Ctrl Z', does: 'Undo', run: () => session.edited().undo(), command: true, shift: false },
        { keys: ['z'], shown: 'Ctrl Shift Z', does: 'Redo', run: () => session.edited().redo(), command: true, shift: true },
        { keys: ['y'], shown: 'Ctrl Y', does: '', run: () => session.edited().redo(), command: true },
        { keys: ['escape'], shown: 'Esc', does: 'Cancel', run: () => session.cancel() },
      ],
    },
    {
      title: 'Masks',
      keys: [
        { keys: NUMBERS, shown: '1 … 9', does: 'Select a mask by its place in the list', run: (name) => selectMask(store, session, Number(name)) },
        { keys: ['f2'], shown: 'F2', does: 'Rename the selected mask, as a double click on its name does', run: renameSelected },
        { keys: ['t'], shown: 'T', does: 'Class of the selected objects', run: toClass },
        { keys: ['l'], shown: 'Shift L', does: 'Lock the selected objects, or unlock them', run: () => session.objects.toggleLock(...chosen(store)), shift: true },
        { keys: ['delete', 'backspace'], shown: 'Delete', does: 'Delete the selected objects', run: () => session.objects.remove(...chosen(store)) },
        { keys: ['>'], shown: '>', does: 'Copy the selected mask to the next frame', run: () => void copyMask(session, 1) },
        { keys: ['<'], shown: '<', does: 'Copy the selected mask to the frame before', run: () => void copyMask(session, -1) },
      ],
    },
    {
      title: 'What is shown',
      keys: [
        { keys: [], shown: 'F', does: 'Show the other frame while held', run: () => undefined },
        { keys: ['f'], shown: 'Shift F', does: 'Alternate between the frames', run: () => toggleBlinking(store), shift: true },
        { keys: ['s'], shown: 'S', does: 'Split view', run: () => store.look({ view: store.get().look.view === 'split' ? 'first' : 'split', blinking: false }) },
        { keys: ['g'], shown: 'G', does: 'Switch between objects and motions', run: () => session.shown.kind(store.get().look.kind === 'groups' ? 'motions' : 'groups') },
        { keys: ['l'], shown: 'L', does: 'Outlines', run: toggle('outlines'), shift: false },
        { keys: ['u'], shown: 'U', does: 'Onion skin: outlines of the objects in the frames before and after', run: toggle('onion') },
        { keys: ['a'], shown: 'A', does: 'Flow arrows', run: toggle('arrows') },
        { keys: ['r'], shown: 'R', does: 'Residual: what the motions do not explain', run: toggle('residual') },
        { keys: ['+', '='], shown: '+', does: 'Zoom in', run: () => zoom.by(ZOOM_STEP) },
        { keys: ['-', '_'], shown: '−', does: 'Zoom out', run: () => zoom.by(1 / ZOOM_STEP) },
        { keys: ['0'], shown: '0', does: 'Fit the picture', run: () => zoom.whole() },
        { keys: ['z'], shown: 'Z', does: 'Zoom to 100 %', run: () => zoom.actual() },
        { keys: ['?'], shown: '?', does: 'Show this list', run: () => undefined },
      ],
    },
    {
      title: 'With the picture focused by Tab',
      keys: [
        { keys: ['arrowleft'], shown: '←', does: 'Pan the enlarged picture, or move the brush', run: pan(1, 0), when: pans },
        { keys: ['arrowright'], shown: '→', does: '', run: pan(-1, 0), when: pans },
        { keys: ['arrowup'], shown: '↑', does: '', run: pan(0, 1), when: pans },
        { keys: ['arrowdown'], shown: '↓', does: '', run: pan(0, -1), when: pans },
        { keys: [], shown: 'Space', does: 'Start or end a stroke or a box, set a corner', run: () => undefined },
      ],
    },
  ];
}

/** Selects the object or mask with this place in the list, after the background. */
function selectMask(store: Store, session: Session, place: number): void {
  const { look, tracked, result } = store.get();
  const ofClip = look.kind === 'objects' && tracked !== null;
  const ids = ofClip ? livesOf(tracked).map(({ id }) => id) : result === null ? [] : masksOf(result.segmentation, look.kind).slice(1).map(({ id }) => id);
  const id = ids[place - 1];
  if (id !== undefined) session.shown.select(id);
}

/** The objects of a clip that are selected. */
function chosen(store: Store): number[] {
  const { look, tracked } = store.get();
  return look.kind === 'objects' && tracked !== null ? selectedIn(look).filter((id) => id !== 0) : [];
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
