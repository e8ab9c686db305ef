//! The tools: view, brush, eraser, polygon, box; the size of the brush, what a press is, what follows, whether drawing is exact; undo and redo.

import { type VNode, render } from 'preact';
import type { Session } from '../session/session.js';
import type { Pointing, Store, Tool, ToolName } from '../state/state.js';
import { isSeen } from '../state/tracked.js';
import { usePart } from './component.js';
import { Icon } from './icon.js';
import { pointingIn, promptIn } from './pointing.js';

export const RADII = { least: 2, most: 60 } as const;

/** Name, and the picture of each: a path in 20 × 20 units. */
const TOOLS: readonly (readonly [ToolName, string, string])[] = [
  ['look', 'View', 'M5 3l10 7-4.6 1L8 16z'],
  ['brush', 'Brush', 'M16 3L8.5 10.5M7 11c-2 0-2.6 1.6-2.6 3 0 1-.6 1.6-1.4 2 3.4 1 6.5.2 6.5-2.5A2.5 2.5 0 0 0 7 11z'],
  ['eraser', 'Eraser', 'M8 16L3.5 11.5 11 4l5.5 5.5L10 16zM7.5 7.5l5.5 5.5M8 16h8'],
  ['polygon', 'Polygon', 'M4.5 8L11 4l5 5-2 7H6zM4.5 8h.01M11 4h.01M16 9h.01M14 16h.01M6 16h.01'],
  ['box', 'Box', 'M4 7V4h3M13 4h3v3M16 13v3h-3M7 16H4v-3M9 10h2M10 9v2'],
];

const PRESSES: readonly (readonly [Pointing, string, string])[] = [
  ['new', 'New', 'A new object'],
  ['add', 'Add', 'More of the selected object (Shift)'],
  ['remove', 'Remove', 'Not of the selected object (Alt, or the right button)'],
];

const FOLLOW = 'Frames that follow a correction';

/** In a narrow rail the sign alone is seen: two em spaces follow it. */
const SPREADS: readonly (readonly [Tool['spread'], string])[] = [
  ['both', '↔\u2003\u2003both ways'],
  ['forward', '→\u2003\u2003later frames'],
  ['backward', '←\u2003\u2003earlier frames'],
  ['none', '·\u2003\u2003this frame alone'],
];

export function mountTools(form: HTMLFormElement, store: Store, session: Session): void {
  form.addEventListener('submit', (event) => event.preventDefault());
  render(<Tools store={store} session={session} />, form);
  // Where there is nothing to correct, no object could be new.
  store.subscribe(({ tool, tracked }) => {
    if (tool.name === 'box' && !isSeen(tracked)) chooseTool(store, 'look');
  });
}

function Tools({ store, session }: { store: Store; session: Session }): VNode {
  const tool = usePart(store, (state) => state.tool);
  const isUsable = usePart(store, ({ result, live }) => result !== null && live === null);
  const isClip = usePart(store, ({ tracked }) => isSeen(tracked));
  const pointing = usePart(store, pointingIn);
  const isRefined = usePart(store, (state) => promptIn(state) !== null);
  const undo = usePart(store, ({ tracked }) => tracked?.steps.undo ?? 0);
  const redo = usePart(store, ({ tracked }) => tracked?.steps.redo ?? 0);
  const set = (change: Partial<Tool>): void => store.set({ tool: { ...store.get().tool, ...change } });
  return (
    <>
      <fieldset class="rail">
        <legend class="visually-hidden">Tool</legend>
        {TOOLS.map(([name, title, path]) => (
          <label key={name} hidden={name === 'box' && !isClip}>
            <input
              type="radio"
              name="tool"
              value={name}
              checked={tool.name === name}
              disabled={!isUsable && name !== 'look'}
              aria-label={name === 'box' ? 'Box: a new object' : undefined}
              onChange={() => chooseTool(store, name)}
            />
            <span>
              <Icon path={path} />
              {title}
            </span>
          </label>
        ))}
      </fieldset>
      <div class="options">
        <div class="of-tool">
          <label class="size">
            <span>
              Size <output>{tool.radius}</output>
            </span>{' '}
            <input
              type="range"
              name="radius"
              min={RADII.least}
              max={RADII.most}
              step="1"
              value={tool.radius}
              aria-label="Brush radius in pixels"
              onInput={({ currentTarget }) => set({ radius: currentTarget.valueAsNumber })}
            />
          </label>
          <fieldset class="pointing">
            <legend class="visually-hidden">What a press or a box is</legend>
            {PRESSES.map(([name, title, help]) => (
              <label key={name} title={help}>
                <input
                  type="radio"
                  name="pointing"
                  value={name}
                  checked={pointing === name}
                  disabled={!isRefined && name !== 'new'}
                  onChange={() => set({ pointing: name })}
                />
                <span>{title}</span>
              </label>
            ))}
          </fieldset>
        </div>
        <label class="follow" hidden={!isClip}>
          <span>Follow</span>
          <select
            name="spread"
            aria-label={FOLLOW}
            title={FOLLOW}
            value={tool.spread}
            disabled={tool.exact}
            onChange={({ currentTarget }) => set({ spread: currentTarget.value as Tool['spread'] })}
          >
            {SPREADS.map(([value, title]) => (
              <option key={value} value={value}>
                {title}
              </option>
            ))}
          </select>
        </label>
        <label class="exact" title="What is drawn is kept pixel for pixel, and nothing follows (Q)">
          <input type="checkbox" name="exact" checked={tool.exact} onChange={({ currentTarget }) => set({ exact: currentTarget.checked })} />
          <span>
            <Icon path="M4 4h8v4h4v8H8v-4H4z" />
            Exact
          </span>
        </label>
      </div>
      <div class="steps">
        <button type="button" id="undo" class="tool-step" title="Undo" disabled={undo === 0} onClick={() => session.undo()}>
          <Icon path="M7 4L3 8l4 4M3 8h8a5 5 0 0 1 0 9H8" />
          Undo
        </button>
        <button type="button" id="redo" class="tool-step" title="Redo" disabled={redo === 0} onClick={() => session.redo()}>
          <Icon path="M13 4l4 4-4 4M17 8H9a5 5 0 0 0 0 9h3" />
          Redo
        </button>
      </div>
    </>
  );
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
