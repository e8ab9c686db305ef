//! Brush, eraser, polygon and box: the circle under the pointer, and what is being drawn.

import type { Path } from '../result/strokes.js';
import { colourOfMask } from '../drawing/paint.js';
import { cssColour } from '../drawing/palette.js';
import { Drawing } from '../session/clip/drawing.js';
import type { Session } from '../session/session.js';
import type { Pointing, State, Store, ToolName } from '../state/state.js';
import { mountCursor } from './cursor.js';
import { drawn, find } from './markup.js';
import { mountPointing, pointingIn } from './pointing.js';
import { cornersOf, dotsOf, isPolygon, setCorner, takeBack } from './polygon.js';

type Point = readonly [number, number];

/** Directions of the arrow keys. */
const STEPS: Readonly<Record<string, Point>> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Radius of the circle for the corners of a box or a polygon, pixels of the picture before it is enlarged. */
const CORNER = 3;

/** A point is recorded at this distance from the last, share of the radius. */
const NEXT_POINT = 0.3;

export class Brush {
  readonly #store: Store;
  readonly drawing: Drawing;
  readonly #picture: SVGSVGElement;
  readonly #help: HTMLElement;
  readonly #circle = drawn('circle', { class: 'brush', r: 0 });
  readonly #path = drawn('path', { class: 'stroke now' });
  readonly #corners = drawn('path', { class: 'corners' });
  readonly #prompt = drawn('g', {});
  /** The stroke under way, and who takes it: it belongs to the tool and the mask that were selected when it began. */
  #now: { readonly tool: ToolName; readonly points: number[]; readonly take: (path: Path) => void } | null = null;
  /** Whether the pointer was pressed for what is being drawn. A polygon goes on when it is lifted. */
  #pressed = false;
  /** The last position of the brush. */
  #at: Point | null = null;
  /** Called when nothing is being drawn any more. */
  #waiting: (() => void)[] = [];

  constructor(stage: HTMLElement, store: Store, session: Session) {
    this.#store = store;
    this.drawing = new Drawing(store, session.objects);
    this.#picture = find(stage, '#strokes', SVGSVGElement);
    this.#help = find(stage, '#tool-help', HTMLElement);
    this.#picture.append(this.#prompt, this.#path, this.#corners, this.#circle);
    session.objects.finishStroke = () => this.#finish();
    session.objects.drawn = () => this.drawn();
    this.#fit(store.get());
    this.#dress(store.get());
    mountPointing(this.#prompt, store);
    mountCursor(find(stage, '.layers', HTMLElement), store);
    store.subscribe((now, before) => {
      if (now.pair !== before.pair) {
        this.abandon();
        this.#at = null;
        this.#fit(now);
      }
      if (now.tool.name !== before.tool.name) {
        this.#finish();
        this.#help.classList.remove('read');
      }
      if (now.tool !== before.tool || now.look.selected !== before.look.selected) this.#dress(now);
    });
  }

  /**
   * Handles keys while the picture has focus: arrow keys move the brush, Space starts and ends a stroke or a box and sets a corner of a
   * polygon, Enter closes that and Backspace takes a corner back, Escape discards what is being drawn. With Shift a box adds to the selected
   * object. Returns whether the key was handled.
   */
  key({ key, shiftKey }: KeyboardEvent): boolean {
    const { tool, result } = this.#store.get();
    if (tool.name === 'look' || result === null) return false;
    const { width, height } = result.frame;
    const [x, y] = this.#at ?? [width / 2, height / 2];
    const step = shiftKey ? 1 : Math.max(2, tool.radius);
    const [right, down] = STEPS[key] ?? [0, 0];
    const polygon = this.#polygon;
    if (key === ' ') {
      const ends = this.painting;
      if (!ends || polygon) this.begin([x, y], shiftKey ? 'add' : null);
      if (ends || tool.name === 'polygon') this.end(0, shiftKey);
    } else if (key === 'Escape' && this.painting) this.abandon();
    else if (key === 'Enter' && polygon) this.#close(shiftKey);
    else if (key === 'Backspace' && this.painting) {
      // Only a polygon has corners; of a stroke it takes nothing back, and is not about the selected object either.
      if (polygon && takeBack(polygon)) this.#trace();
      else if (polygon) this.abandon();
    }
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
    this.#circle.setAttribute('r', String(radiusOf(this.#store.get())));
    if (!this.#polygon) return;
    this.#polygon.splice(-2, 2, x, y);
    this.#trace();
  }

  /** Ends when nothing is being drawn. */
  async drawn(): Promise<void> {
    if (this.painting) await new Promise<void>((resolve) => this.#waiting.push(resolve));
  }

  /** Hides the circle when the pointer leaves. */
  leave(): void {
    if (!this.painting) this.#circle.setAttribute('r', '0');
  }

  /** `pointing`: what a box or a press is, if that is not what is chosen. */
  begin(point: Point, pointing: Pointing | null = null): void {
    const { tool } = this.#store.get();
    if (tool.name === 'look') return;
    this.#store.set({ playing: false });
    this.#help.classList.add('read');
    this.#pressed = true;
    if (!this.#polygon) {
      const take = tool.name === 'box' ? this.drawing.beginPrompt(pointing ?? pointingIn(this.#store.get())) : this.drawing.beginStroke(tool.name === 'eraser' ? 'eraser' : 'brush');
      if (take !== null) this.#now = { tool: tool.name, points: [...point], take };
    }
    this.hover(point);
    this.#trace();
  }

  move([x, y]: Point): void {
    this.hover([x, y]);
    if (this.#now === null || this.#polygon) return;
    const { points, tool } = this.#now;
    const [lastX, lastY] = [points.at(-2) ?? 0, points.at(-1) ?? 0];
    if (tool === 'box') points.splice(2, 2, x, y);
    else if (Math.hypot(x - lastX, y - lastY) < NEXT_POINT * this.#store.get().tool.radius) return;
    else points.push(x, y);
    this.#trace();
  }

  /**
   * The pointer is lifted: that ends a stroke or a box, and sets a corner of a polygon or closes it. `reach`: how near the first corner is
   * enough for that, pixels of the screen; `erases`: a polygon is then removed from the mask.
   */
  end(reach = 0, erases = false): void {
    const now = this.#now;
    if (now === null || !this.#pressed) return;
    this.#pressed = false;
    if (this.#polygon) return setCorner(now.points, reach / (this.#picture.getScreenCTM()?.a ?? 1)) ? this.#close(erases) : this.#trace();
    this.#clear();
    now.take({ points: now.points, radius: this.#store.get().tool.radius });
  }

  /** A second finger or the browser takes over: a stroke that has moved stays, and so do the corners of a polygon. Half a box is none. */
  interrupt(moved: boolean): void {
    if (moved && this.#now?.tool !== 'box' && !this.#polygon) this.end();
    else if ((this.#polygon?.length ?? 0) <= 2) this.abandon();
    this.#pressed = false;
  }

  abandon(): void {
    this.#clear();
    this.leave();
  }

  #clear(): void {
    this.#now = null;
    this.#trace();
    for (const go of this.#waiting.splice(0)) go();
  }

  /** The points of the polygon that is being drawn. */
  get #polygon(): number[] | null {
    return this.#now?.tool === 'polygon' ? this.#now.points : null;
  }

  /** Another tool is chosen, or the frames are left. */
  #finish(): void {
    if (this.#polygon) this.abandon();
    else this.end();
  }

  #close(erases: boolean): void {
    const points = cornersOf(this.#polygon ?? []);
    const take = erases ? this.drawing.beginStroke('eraser') : this.#now?.take;
    if (!take || !isPolygon(points)) return;
    this.#clear();
    take({ points, radius: 0, filled: true });
  }

  #trace(): void {
    const { tool, points } = this.#now ?? { tool: '', points: [] };
    const path = tool === 'box' ? boxOf : pathOf;
    this.#path.setAttribute('d', points.length === 0 ? '' : path(points, tool === 'polygon'));
    this.#path.setAttribute('stroke-width', String(2 * this.#store.get().tool.radius));
    this.#corners.setAttribute('d', tool === 'polygon' ? dotsOf(cornersOf(points)) : '');
  }

  /** Strokes are in pixels of the frame, whatever its masks are, and whether there are any. */
  #fit({ pair }: State): void {
    const frame = pair.first;
    if (frame !== null) this.#picture.setAttribute('viewBox', `-0.5 -0.5 ${frame.width} ${frame.height}`);
  }

  /** The circle has the colour of the selected mask; the style sheet dashes the eraser's. */
  #dress(now: State): void {
    const { tool, look } = now;
    this.#picture.style.setProperty('--colour', look.selected === null ? 'white' : cssColour(colourOfMask(look.selected, look)));
    if (tool.name === 'look') this.#circle.setAttribute('r', '0');
    else if (this.#circle.getAttribute('r') !== '0') this.#circle.setAttribute('r', String(radiusOf(now)));
  }
}

function radiusOf({ tool: { name, radius }, viewport }: State): number {
  return name === 'box' || name === 'polygon' ? CORNER / viewport.zoom : radius;
}

/** The rectangle with two corners. */
function boxOf([x = 0, y = 0, right = x, bottom = y]: readonly number[]): string {
  return `M${x.toFixed(1)} ${y.toFixed(1)}H${right.toFixed(1)}V${bottom.toFixed(1)}H${x.toFixed(1)}Z`;
}

function pathOf(points: readonly number[], isClosed: boolean): string {
  const pairs = Array.from({ length: points.length / 2 }, (_, i) => `${points[2 * i]!.toFixed(1)} ${points[2 * i + 1]!.toFixed(1)}`);
  return `M${pairs.join('L')}${pairs.length === 1 ? 'h0.01' : isClosed ? 'Z' : ''}`;
}
