// The picture magnified. Loaded when a person zooms.

const LARGEST = 16;
/** By how much a wheel turns to double the picture, pixels. */
const DOUBLE = 240;

export class Zoom {
  readonly #stage: HTMLElement;
  readonly #view: HTMLElement;
  #scale = 1;
  /** The top left corner, as a share of the stage's size. */
  #corner: readonly [x: number, y: number] = [0, 0];

  constructor(stage: HTMLElement, view: HTMLElement) {
    this.#stage = stage;
    this.#view = view;
  }

  wheel({ deltaY, clientX, clientY }: WheelEvent): void {
    const box = this.#stage.getBoundingClientRect();
    this.by(2 ** (-deltaY / DOUBLE), [(clientX - box.left) / box.width, (clientY - box.top) / box.height]);
  }

  /** What is at a place, a share of the stage's size, stays there. */
  by(factor: number, place: readonly [x: number, y: number] = [0.5, 0.5]): void {
    const scale = Math.max(1, Math.min(LARGEST, factor * this.#scale));
    const along = (axis: 0 | 1) =>
      Math.max(1 - scale, Math.min(0, place[axis] - ((place[axis] - this.#corner[axis]) * scale) / this.#scale));
    this.#corner = [along(0), along(1)];
    this.#scale = scale;
    const [x, y] = this.#corner.map((share) => `${100 * share}%`);
    this.#view.style.transform = `translate(${x}, ${y}) scale(${scale})`;
  }
}
