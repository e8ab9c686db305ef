//! The tools: view, brush, eraser, polygon, box; the size of the brush, what follows, whether drawing is exact; undo and redo.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import { type State, type Store, type Tool, type ToolName, seenIn } from '../state/state.js';
import { isDrafting, isReady, isSeen, lockedIn, takesCorrections } from '../state/tracked.js';
import { find } from './markup.js';

export const RADII = { least: 2, most: 60 } as const;

export function mountTools(form: HTMLFormElement, store: Store, session: Session): void {
  const names = ['look', 'brush', 'eraser', 'polygon', 'box'] as const;
  const radios = names.map((name) => find(form, `[name=tool][value=${name}]`, HTMLInputElement));
  const size = find(form, '[name=radius]', HTMLInputElement);
  const sizeValue = find(form, '.size output', HTMLElement);
  const helps = names.map((name) => ({ name, help: find(document, `#tool-help [data-help=${name}]`, HTMLElement) }));
  const spread = find(form, '[name=spread]', HTMLSelectElement);
  const exact = find(form, '[name=exact]', HTMLInputElement);
  const undo = find(form, '#undo', HTMLButtonElement);
  const redo = find(form, '#redo', HTMLButtonElement);

  form.addEventListener('submit', (event) => event.preventDefault());
  for (const radio of radios) radio.addEventListener('change', () => chooseTool(store, radio.value as ToolName));
  size.addEventListener('input', () => store.set({ tool: { ...store.get().tool, radius: size.valueAsNumber } }));
  spread.addEventListener('change', () => store.set({ tool: { ...store.get().tool, spread: spread.value as Tool['spread'] } }));
  exact.addEventListener('change', () => store.set({ tool: { ...store.get().tool, exact: exact.checked } }));
  undo.addEventListener('click', () => session.undo());
  redo.addEventListener('click', () => session.redo());

  const render = (): void => {
    const { tool, result, live, look, tracked } = store.get();
    const clip = isSeen(tracked) ? tracked : null;
    // Where there is nothing to correct, no object could be new.
    if (clip === null && tool.name === 'box') return chooseTool(store, 'look');
    const usable = result !== null && live === null;
    for (const radio of radios) {
      radio.checked = radio.value === tool.name;
      radio.disabled = !usable && radio.value !== 'look';
      if (radio.value === 'box') radio.parentElement!.hidden = clip === null;
    }
    size.value = sizeValue.textContent = String(tool.radius);
    spread.value = tool.spread;
    spread.parentElement!.hidden = clip === null;
    spread.disabled = exact.checked = tool.exact;
    for (const { name, help } of helps) {
      help.textContent = strings.toolHelp(name, tool.exact, clip !== null && look.selected === 0, whyNot(store.get(), name));
      help.classList.toggle('away', tool.name !== name);
    }
    undo.disabled = tracked === null || tracked.steps.undo === 0;
    redo.disabled = tracked === null || tracked.steps.redo === 0;
  };
  store.subscribe((now, before) => {
    const same = (['tool', 'result', 'live', 'tracked', 'pair'] as const).every((part) => now[part] === before[part]);
    if (!same || now.look.selected !== before.look.selected) render();
  });
  render();
}

/** Why nothing can be drawn with a tool on the frame that is seen; `null` if something can. */
function whyNot(state: State, tool: ToolName): string | null {
  const { tracked, look } = state;
  if (!isReady(tracked) || isDrafting(tracked)) return isDrafting(tracked) ? strings.notices.drafts : strings.notices.notReady;
  const seen = seenIn(state);
  if (seen !== null && !takesCorrections(tracked, seen.index)) return strings.notTracked;
  if (tool === 'box') return null;
  if (look.selected === null) return strings.notices.chooseMask;
  return lockedIn(tracked).has(look.selected) ? strings.notices.isLocked(nameOf(look, look.selected)) : null;
}

/** Selects a tool. For drawing it shows the first frame and the objects of the clip, and selects one if none is. */
export function chooseTool(store: Store, name: ToolName): void {
  const { tool, look, result, tracked } = store.get();
  if (name === 'box' && !isSeen(tracked)) return;
  store.set({ tool: { ...tool, name } });
  if (name === 'look') return;
  const selected = look.selected ?? (result && (result.masks.objects[0]?.id ?? 0));
  store.look({ view: 'first', blinking: false, motions: false, selected });
}

export function changeRadius(store: Store, factor: number): void {
  const { tool } = store.get();
  const least = tool.radius + Math.sign(factor - 1); // a small brush changes, too
  const changed = factor > 1 ? Math.max(Math.round(tool.radius * factor), least) : Math.min(Math.round(tool.radius * factor), least);
  const radius = Math.min(Math.max(changed, RADII.least), RADII.most);
  store.set({ tool: { ...tool, radius } });
}
