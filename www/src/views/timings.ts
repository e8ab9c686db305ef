//! The time of each stage.

import { strings } from '../common/strings.js';
import { type Result, type State, type Store, isAwaited } from '../state/state.js';
import { find } from './markup.js';

export function mountTimings(root: HTMLElement, store: Store): void {
  const body = find(root, 'tbody', HTMLElement);
  const render = (now: State): void => {
    const { result } = now;
    if (isAwaited(now)) return;
    root.hidden = result === null || now.look.kind === 'objects';
    body.replaceChildren(...(result === null ? [] : linesOf(result).map(([what, ms]) => line(what, ms))));
  };
  store.subscribe((now, before) => {
    if (now.result !== before.result || isAwaited(before)) render(now);
  });
  render(store.get());
}

function linesOf({ pair, segmentation, waited }: Result): [string, number][] {
  const { total, ...stages } = segmentation.milliseconds;
  return [
    [strings.timings.decode(pair.first.name), pair.first.decoded],
    [strings.timings.decode(pair.second.name), pair.second.decoded],
    ...Object.entries(stages).map(([stage, ms]): [string, number] => [strings.stage(stage), ms]),
    [strings.timings.total, total],
    [strings.timings.waited, waited],
  ];
}

function line(what: string, ms: number): HTMLTableRowElement {
  const row = document.createElement('tr');
  const head = document.createElement('th');
  head.scope = 'row';
  head.textContent = what;
  row.append(head);
  row.insertCell().textContent = strings.milliseconds(ms);
  return row;
}
