//! Brush, eraser and box: the circle under the pointer, the stroke or the box being drawn, and earlier strokes.

import { maskWith, strokesOf } from '../correction/edits.js';
import { labellingOf, labelsIn } from '../correction/parts.js';
import { type Path, allowedLabels } from '../correction/strokes.js';
import { colourOfMask } from '../drawing/paint.js';
import { type Colour, cssColour } from '../drawing/palette.js';
import type { Session } from '../session/session.js';
import type { State, Store } from '../state/state.js';
import { drawn, find } from './markup.js';

type Point = readonly [number, number];

/** Directions of the arrow keys. */
const STEPS: Readonly<Record<string, Point>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** The colour of the eraser, and of strokes whose mask is not in the result. */
const COLOURLESS: Colour = [20, 20, 20];

/** Radius of the circle where a box begins, pixels. */
const CORNER = 3;

/** A point is recorded at this distance from the last, share of the radius. */
const NEXT_POINT = 0.3;

export class Brush {
  readonly #store: Store;
  readonly #session: Session;
  readonly #picture: SVGSVGElement;
  readonly #circle = drawn('circle', { class: 'brush', r: 0 });
  readonly #path = drawn('path', { class: 'stroke now' });
  readonly #strokes = drawn('g', {});
  /** The stroke being drawn, and what takes it: it belongs to the tool and the mask that were selected when it began. */
  #now: { readonly points: number[]; readonly take: (path: Path) => void } | null = null;
  /** The last position of the brush. */
  #at: Point | null = null;

  constructor(stage: HTMLElement, store: Store, session: Session) {
    this.#store = store;
    this.#session = session;
    this.#picture = find(stage, '#strokes', SVGSVGElement);
    this.#picture.append(this.#strokes, this.#path, this.#circle);
    session.masks.finishStroke = () => this.end();
    store.subscribe((now, before) => {
      if (now.pair !== before.pair) {
        this.abandon();
        this.#at = null;
        // Strokes are in pixels of the frame, whatever its masks are, and whether there are any.
        const frame = now.pair.first ?? now.pair.second;
        if (frame !== null) this.#picture.setAttribute('viewBox', `-0.5 -0.5 ${frame.width} ${frame.height}`);
      }
      if (now.tool.name !== before.tool.name) this.end();
      if (now.tool !== before.tool || now.look.selected !== before.look.selected) this.#dress(now);
      const same = now.edits === before.edits && now.tool.name === before.tool.name && now.result === before.result && now.look === before.look;
      if (!same) this.#draw(now);
    });
  }

  /**
   * Handles keys while the picture has focus: arrow keys move the brush, Space starts and ends a stroke or a box, Escape discards it. Returns
   * whether the key was handled.
   */
  key({ key, shiftKey }: KeyboardEvent): boolean {
    const { tool, result } = this.#store.get();
    if (tool.name === 'look' || result === null) return false;
    const { width, height } = result.pair.first;
    const [x, y] = this.#at ?? [width / 2, height / 2];
    const step = shiftKey ? 1 : Math.max(2, tool.radius);
    const [right, down] = STEPS[key] ?? [0, 0];
    if (key === ' ') {
      if (this.painting) this.end();
      else this.begin([x, y]);
    } else if (key === 'Escape' && this.painting) this.abandon();
    else if (right !== 0 || down !== 0) {
      const clamped: Point = [Math.min(Math.max(x + right * step, 0), width - 1), Math.min(Math.max(y + down * step, 0), height - 1)];
      this.move(clamped);
    } else return false;
    return true;
  }

  get painting(): boolean {
    return this.#now !== null;
  }

  hover([x, y]: Point): void {
    this.#at = [x, y];
    this.#circle.setAttribute('cx', String(x));
    this.#circle.setAttribute('cy', String(y));
    this.#circle.setAttribute('r', String(radiusOf(this.#store.get().tool)));
  }

  /** Hides the circle when the pointer leaves. */
  leave(): void {
    if (!this.painting) this.#circle.setAttribute('r', '0');
  }

  begin(point: Point): void {
    const { tool } = this.#store.get();
    if (tool.name === 'look') return;
    const take = tool.name === 'box' ? this.#session.objects.beginBox() : this.#session.edited().beginStroke(tool.name);
    if (take !== null) this.#now = { points: [...point], take };
    this.hover(point);
    this.#trace();
  }

  move([x, y]: Point): void {
    this.hover([x, y]);
    if (this.#now === null) return;
    const { points } = this.#now;
    const [lastX, lastY] = [points.at(-2) ?? 0, points.at(-1) ?? 0];
    if (this.#store.get().tool.name === 'box') points.splice(2, 2, x, y);
    else if (Math.hypot(x - lastX, y - lastY) < NEXT_POINT * this.#store.get().tool.radius) return;
    else points.push(x, y);
    this.#trace();
  }

  end(): void {
    const now = this.#now;
    this.#now = null;
    this.#trace();
    now?.take({ points: now.points, radius: this.#store.get().tool.radius });
  }

  abandon(): void {
    this.#now = null;
    this.#trace();
    this.leave();
  }

  #trace(): void {
    const { tool } = this.#store.get();
    const path = tool.name === 'box' ? boxOf : pathOf;
    this.#path.setAttribute('d', this.#now === null ? '' : path(this.#now.points));
    this.#path.setAttribute('stroke-width', String(2 * tool.radius));
  }

  /** The circle has the colour of the selected mask; the style sheet dashes the eraser's. */
  #dress({ tool, look }: State): void {
    this.#picture.dataset.tool = tool.name;
    this.#picture.style.setProperty('--colour', look.selected === null ? 'white' : cssColour(colourOfMask(look.selected, look)));
    if (tool.name === 'look') this.#circle.setAttribute('r', '0');
    else if (this.#circle.getAttribute('r') !== '0') this.#circle.setAttribute('r', String(radiusOf(tool)));
  }

  #draw({ edits, tool, result, found, look }: State): void {
    if (result === null || found === null || tool.name === 'look') return this.#strokes.replaceChildren();
    const { segmentation } = result;
    this.#strokes.replaceChildren(
      ...strokesOf(edits).map((stroke) => {
        const mask = stroke.tool === 'brush' ? maskWith(labelsIn(stroke.mask, labellingOf(found)), segmentation, look.kind) : null;
        const colour = mask === null ? COLOURLESS : colourOfMask(mask, look);
        const className = allowedLabels(stroke, found) === 0 ? 'stroke ineffective' : 'stroke';
        return drawn('path', { class: className, d: pathOf(stroke.points), 'stroke-width': 2 * stroke.radius, stroke: cssColour(colour) });
      }),
    );
  }
}

function radiusOf({ name, radius }: State['tool']): number {
  return name === 'box' ? CORNER : radius;
}

/** The rectangle with two corners. */
function boxOf([x = 0, y = 0, right = x, bottom = y]: readonly number[]): string {
  return `M${x.toFixed(1)} ${y.toFixed(1)}H${right.toFixed(1)}V${bottom.toFixed(1)}H${x.toFixed(1)}Z`;
}

function pathOf(points: readonly number[]): string {
  const pairs = Array.from({ length: points.length / 2 }, (_, i) => `${points[2 * i]!.toFixed(1)} ${points[2 * i + 1]!.toFixed(1)}`);
  return `M${pairs.join('L')}${pairs.length === 1 ? 'h0.01' : ''}`;
}
