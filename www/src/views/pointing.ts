//! The meaning of a press with the box tool: a new object, or more or less of the selected one, whose clicks and box are shown in the picture.

import { type Pointing, type State, type Store, seenIn } from '../state/state.js';
import { type Prompt, promptOf } from '../state/tracked.js';
import { drawn } from './markup.js';

/** Radius of a disc, and half the length of the lines in it, pixels of the screen. */
const [DISC, LINE] = [7, 4];

/** The meaning of a press, unless a key changes it. */
export function pointingIn(state: State): Pointing {
  return promptIn(state) === null ? 'new' : state.tool.pointing;
}

/** The prompt of the selected object in the frame on screen, which can be refined; `null` if there is none. */
export function promptIn(state: State): Prompt | null {
  const { tracked, look } = state;
  return tracked === null ? null : promptOf(tracked, seenIn(state)?.index ?? null, look.selected);
}

export function mountPointing(marks: SVGGElement, store: Store): void {
  const render = (now: State): void => {
    const prompt = promptIn(now);
    const isShown = now.tool.name === 'box' && prompt !== null;
    const masks = isShown ? now.tracked?.frames[seenIn(now)?.index ?? -1]?.runs : undefined;
    const unit = 1 / (marks.ownerSVGElement?.getScreenCTM()?.a ?? 1);
    marks.replaceChildren(...(isShown && masks ? marksOf(prompt, (now.pair.first?.width ?? masks.width) / masks.width, unit) : []));
  };
  store.subscribe((now, before) => {
    if ((['tool', 'look', 'tracked', 'viewport', 'pair'] as const).some((part) => now[part] !== before[part])) render(now);
  });
  render(store.get());
}

/** Clicks as discs with a plus or a minus, and the box. `scale`: pixels of the frame for each of the masks; `unit`: for one of the screen. */
function marksOf({ clicks, box }: Prompt, scale: number, unit: number): SVGElement[] {
  const place = (value: number): number => (value + 0.5) * scale - 0.5;
  const [x, y, width, height] = box ?? [];
  const boxes = x === undefined ? [] : [drawn('rect', { class: 'prompt box', x: x * scale - 0.5, y: y! * scale - 0.5, width: width! * scale, height: height! * scale })];
  const discs = clicks.map(([column, row, sign]) => {
    const [radius, half, left] = [DISC * unit, LINE * unit, place(column) - DISC * unit];
    const plus = sign > 0 ? `M${place(column)} ${place(row) - half}v${2 * half}` : '';
    const disc = `M${left} ${place(row)}a${radius} ${radius} 0 1 0 ${2 * radius} 0a${radius} ${radius} 0 1 0 ${-2 * radius} 0z`;
    return drawn('path', { class: sign > 0 ? 'prompt plus' : 'prompt minus', d: `${disc}M${place(column) - half} ${place(row)}h${2 * half}${plus}` });
  });
  return [...boxes, ...discs];
}
