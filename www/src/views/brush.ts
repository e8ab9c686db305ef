//! The brush: the circle under the pointer, the stroke being drawn, and the strokes that were drawn.

import { maskOf } from '../masks.js';
import { colourOfMask } from '../paint.js';
import { cssColour } from '../palette.js';
import type { Session } from '../session.js';
import type { State, Store } from '../state.js';
import { strings } from '../strings.js';
import type { Stroke } from '../strokes.js';
import { drawn, find } from './markup.js';

type Point = readonly [number, number];

/** Where the arrow keys lead. */
const STEPS: Readonly<Record<string, Point>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Points nearer than this share of the radius to the last say nothing new. */
const NEXT_POINT = 0.3;

export class Brush {
  readonly #store: Store;
  readonly #session: Session;
  readonly #picture: SVGSVGElement;
  readonly #circle = drawn('circle', { class: 'brush', r: 0 });
  readonly #path = drawn('path', { class: 'stroke now' });
  readonly #strokes = drawn('g', {});
  #points: number[] | null = null;
  /** Where the brush was last. */
  #at: Point | null = null;

  constructor(stage: HTMLElement, store: Store, session: Session) {
    this.#store = store;
    this.#session = session;
    this.#picture = find(stage, '#strokes', SVGSVGElement);
    this.#picture.append(this.#strokes, this.#path, this.#circle);
    store.subscribe((now, before) => {
      if (now.pair !== before.pair) {
        this.abandon();
        this.#at = null;
      }
      if (now.tool !== before.tool || now.look.selected !== before.look.selected) this.#dress(now);
      const same = now.history.strokes === before.history.strokes && now.tool.name === before.tool.name && now.result === before.result;
      if (!same) this.#draw(now);
    });
  }

  /**
   * With the picture in focus: arrow keys move the brush, Space begins and ends a stroke, Escape gives it up. Returns whether the key
   * meant something.
   */
  key({ key, shiftKey }: KeyboardEvent): boolean {
    const { tool, result } = this.#store.get();
    if (tool.name === 'look' || result === null) return false;
    const { width, height } = result.segmentation;
    const [x, y] = this.#at ?? [width / 2, height / 2];
    const step = shiftKey ? 1 : Math.max(2, tool.radius);
    const [right, down] = STEPS[key] ?? [0, 0];
    if (key === ' ') {
      if (this.painting) void this.end();
      else this.begin([x, y]);
    } else if (key === 'Escape' && this.painting) this.abandon();
    else if (right !== 0 || down !== 0) {
      const clamped: Point = [Math.min(Math.max(x + right * step, 0), width - 1), Math.min(Math.max(y + down * step, 0), height - 1)];
      this.move(clamped);
    } else return false;
    return true;
  }

  get painting(): boolean {
    return this.#points !== null;
  }

  hover([x, y]: Point): void {
    this.#at = [x, y];
    this.#circle.setAttribute('cx', String(x));
    this.#circle.setAttribute('cy', String(y));
    this.#circle.setAttribute('r', String(this.#store.get().tool.radius));
  }

  /** The circle goes when the pointer does. */
  leave(): void {
    if (!this.painting) this.#circle.setAttribute('r', '0');
  }

  begin(point: Point): void {
    const { result, look } = this.#store.get();
    if (result === null) return;
    if (look.selected === null) this.#session.say(strings.notices.chooseMask);
    else this.#points = [...point];
    this.hover(point);
    this.#trace();
  }

  move([x, y]: Point): void {
    this.hover([x, y]);
    const points = this.#points;
    if (points === null) return;
    const [lastX, lastY] = [points.at(-2) ?? 0, points.at(-1) ?? 0];
    if (Math.hypot(x - lastX, y - lastY) < NEXT_POINT * this.#store.get().tool.radius) return;
    points.push(x, y);
    this.#trace();
  }

  async end(): Promise<void> {
    const points = this.#points;
    const { tool, look } = this.#store.get();
    this.#points = null;
    if (points !== null && tool.name !== 'look' && look.selected !== null) {
      await this.#session.correcting.stroke(points, tool.name, look.selected);
    }
    this.#trace();
  }

  abandon(): void {
    this.#points = null;
    this.#trace();
    this.leave();
  }

  #trace(): void {
    this.#path.setAttribute('d', this.#points === null ? '' : pathOf(this.#points));
    this.#path.setAttribute('stroke-width', String(2 * this.#store.get().tool.radius));
  }

  /** The circle is of the mask's colour, the eraser's is broken. */
  #dress({ tool, look }: State): void {
    this.#picture.dataset.tool = tool.name;
    this.#picture.style.setProperty('--colour', look.selected === null ? 'white' : cssColour(colourOfMask(look.selected, look)));
    if (tool.name === 'look') this.#circle.setAttribute('r', '0');
    else if (this.#circle.getAttribute('r') !== '0') this.#circle.setAttribute('r', String(tool.radius));
  }

  #draw({ history, tool, result, look }: State): void {
    if (result !== null) this.#picture.setAttribute('viewBox', `-0.5 -0.5 ${result.segmentation.width} ${result.segmentation.height}`);
    const seen = result === null || tool.name === 'look' ? [] : history.strokes;
    this.#strokes.replaceChildren(
      ...seen.map((stroke) => {
        const own = result === null ? undefined : result.segmentation.motions.find(({ label }) => (stroke.labels >> label) & 1);
        const single = isBrush(stroke, result?.segmentation.count ?? 0);
        const colour = own !== undefined && single ? colourOfMask(maskOf(own.label, result!.segmentation, look.kind), look) : ([20, 20, 20] as const);
        return drawn('path', { class: 'stroke', d: pathOf(stroke.points), 'stroke-width': 2 * stroke.radius, stroke: cssColour(colour) });
      }),
    );
  }
}

/** Whether a stroke says what is, rather than what is not. */
function isBrush({ labels }: Stroke, count: number): boolean {
  let bits = 0;
  for (let label = 0; label < count; label++) bits += (labels >> label) & 1;
  return 2 * bits <= count;
}

function pathOf(points: readonly number[]): string {
  const pairs = Array.from({ length: points.length / 2 }, (_, i) => `${points[2 * i]!.toFixed(1)} ${points[2 * i + 1]!.toFixed(1)}`);
  return `M${pairs.join('L')}${pairs.length === 1 ? 'h0.01' : ''}`;
}
