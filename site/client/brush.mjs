// A brush over a picture: strokes by mouse, pen and touch, or by keys: the arrows move it, Space puts it down and lifts it.

import { set, svg } from './figures/kit.mjs';

/**
 * `area` is a plot over the picture. `describe` names the content of a place. `onStroke` gets the points of a finished stroke, in
 * coordinates of the area.
 */
export function brush(area, { label, at, step, radius, describe, onStroke }) {
  let place = at;
  let points;
  const trail = svg('polyline', { class: 'stroke now' });
  const dot = svg('g', { class: 'brush', tabindex: 0, role: 'slider', 'aria-label': label, 'aria-valuemin': area.x[0], 'aria-valuemax': area.x[1] }, svg('circle', { r: radius }));
  area.handles.append(trail, dot);

  function show() {
    const [x, y] = area.at(...place);
    set(dot, { transform: `translate(${x} ${y})`, 'aria-valuenow': Math.round(place[0]), 'aria-valuetext': `${describe(place)}${points ? ', painting' : ''}` });
    set(trail, { points: pathOf(area, points ?? []), 'stroke-width': 2 * radius });
  }
  function move([x, y]) {
    place = [Math.min(Math.max(x, area.x[0]), area.x[1]), Math.min(Math.max(y, area.y[0]), area.y[1])];
    points?.push(place);
    show();
  }
  function finish() {
    const done = points;
    drop();
    if (done) onStroke(done);
  }
  function drop() {
    points = undefined;
    show();
  }

  dot.addEventListener('keydown', (event) => {
    const far = (event.shiftKey ? 5 : 1) * step;
    const way = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] }[event.key];
    if (way) move([place[0] + way[0], place[1] + way[1]]);
    else if (event.key === 'Escape') drop();
    else if (event.key === ' ' && points) finish();
    else if (event.key === ' ') {
      points = [place];
      show();
    } else return;
    event.preventDefault();
  });
  dot.addEventListener('blur', drop);

  const under = ({ clientX, clientY }) => {
    const box = area.element.getBoundingClientRect();
    return area.from(((clientX - box.left) / box.width) * area.width, ((clientY - box.top) / box.height) * area.height);
  };
  area.element.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    dot.focus({ preventScroll: true });
    area.element.setPointerCapture(event.pointerId);
    points = [];
    move(under(event));
  });
  area.element.addEventListener('pointermove', (event) => points && area.element.hasPointerCapture(event.pointerId) && move(under(event)));
  area.element.addEventListener('pointerup', finish);
  area.element.addEventListener('pointercancel', drop);
  show();
  return { element: dot, show };
}

/** Points as a polyline has them; a single one is drawn as a dot. */
export function pathOf(area, points) {
  const all = points.length === 1 ? [points[0], points[0]] : points;
  return all.map((point) => area.at(...point).map((value) => value.toFixed(1)).join(',')).join(' ');
}
