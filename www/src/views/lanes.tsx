//! A lane for each object on the timeline: the frames that show it, more faintly the less certain they are, as a thin line where they are drafts,
//! and marks where a person has corrected.

import { type VNode, render } from 'preact';
import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { colourOfMask } from '../drawing/paint.js';
import { cssColour } from '../drawing/palette.js';
import type { Session } from '../session/session.js';
import type { Look, State, Store } from '../state/state.js';
import { type Tracked, isDraft, isSeen, livesOf, shownFrames } from '../state/tracked.js';
import { usePart } from './component.js';
import { contextOf, find } from './markup.js';

/** Confidence is drawn between this, nearly transparent, and 1, opaque. A half is as likely background as not. */
const LEAST_CONFIDENCE = 0.5;
const LEAST_OPACITY = 0.2;
/** At least as many lanes have room. */
const LEAST_LANES = 2;
/** Height of a lane in its row, and where it shows drafts. */
const THICKNESS = 0.6;
const THICKNESS_OF_DRAFTS = 0.2;

export function mountLanes(root: HTMLElement, store: Store, session: Session): void {
  render(<Names store={store} session={session} />, find(root, '#lane-names', HTMLElement));
  const canvas = find(root, '#lanes', HTMLCanvasElement);
  const drawNow = ({ tracked, look }: State): void => {
    if (tracked !== null) draw(canvas, tracked, look);
  };
  store.subscribe((now, before) => {
    const { tracked, look } = now;
    const frames = shownFrames(tracked);
    const sameFrames = frames === shownFrames(before.tracked);
    const same = sameFrames && tracked?.annotated === before.tracked?.annotated;
    if (same && look === before.look && hasRoom(now) === hasRoom(before)) return;
    root.classList.toggle('with-lanes', hasRoom(now));
    if (tracked === null) return;
    root.style.setProperty('--lanes', String(Math.max(LEAST_LANES, livesOf({ frames }).length)));
    drawNow(now);
  });
  new ResizeObserver(() => drawNow(store.get())).observe(canvas);
}

/** Whether there is room for lanes: from when a clip is being segmented, so that the picture keeps its place when they come. */
function hasRoom({ tracked }: State): boolean {
  return tracked !== null && (tracked.run.phase === 'working' || isSeen(tracked));
}

/** The names of the objects, beside their lanes. */
function Names({ store, session }: { store: Store; session: Session }): VNode {
  const frames = usePart(store, ({ tracked }) => shownFrames(tracked));
  const look = usePart(store, (state) => state.look);
  return (
    <>
      {livesOf({ frames }).map(({ id }) => {
        const name = nameOf(look, id);
        return (
          <li key={id}>
            <button
              type="button"
              class="lane-name"
              data-object={id}
              aria-label={strings.selectObject(name)}
              aria-pressed={look.selected === id}
              style={{ '--colour': cssColour(colourOfMask(id, look)) }}
              onClick={() => session.shown.select(id)}
            >
              {name}
            </button>
          </li>
        );
      })}
    </>
  );
}

function draw(canvas: HTMLCanvasElement, tracked: Tracked, look: Look): void {
  const dense = Math.min(2, devicePixelRatio);
  canvas.width = Math.max(1, Math.round(canvas.clientWidth * dense));
  canvas.height = Math.max(1, Math.round(canvas.clientHeight * dense));
  const context = contextOf(canvas);
  const frames = shownFrames(tracked);
  const lives = livesOf({ frames });
  const [column, row] = [canvas.width / frames.length, canvas.height / Math.max(LEAST_LANES, lives.length)];
  const places = new Map(lives.map(({ id }, k) => [id, k]));
  frames.forEach((frame, index) => {
    const [left, right] = [Math.floor(index * column), Math.floor((index + 1) * column)];
    const thickness = isDraft(tracked, index) ? THICKNESS_OF_DRAFTS : THICKNESS;
    for (const { id, confidence } of frame?.objects ?? []) {
      const sure = Math.max(0, (confidence - LEAST_CONFIDENCE) / (1 - LEAST_CONFIDENCE));
      context.globalAlpha = LEAST_OPACITY + (1 - LEAST_OPACITY) * sure;
      context.fillStyle = cssColour(colourOfMask(id, look));
      context.fillRect(left, ((places.get(id) ?? 0) + (1 - thickness) / 2) * row, Math.max(1, right - left), thickness * row);
    }
  });
  context.globalAlpha = 1;
  for (const [index, { objects }] of tracked.annotated) {
    for (const [id, place] of places) if (objects.includes(id)) mark(context, (index + 0.5) * column, (place + 0.5) * row, (row * THICKNESS) / 2);
  }
}

/** A diamond that stands out from any lane. */
function mark(context: CanvasRenderingContext2D, x: number, y: number, size: number): void {
  context.beginPath();
  context.moveTo(x, y - size);
  context.lineTo(x + size, y);
  context.lineTo(x, y + size);
  context.lineTo(x - size, y);
  context.closePath();
  context.fillStyle = 'white';
  context.fill();
  context.strokeStyle = 'black';
  context.stroke();
}
