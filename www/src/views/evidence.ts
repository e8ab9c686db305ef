//! The number of motions: how long the description of both frames is with each number, and a button to use it for this pair. The number found
//! need not be that with the shortest: then a sentence explains it.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';
import { type State, type Store, isAwaited } from '../state/state.js';
import { drawn, element, find } from './markup.js';

/** Numbers that are offered even if they have no score. */
const OFFERED = 6;

/** Units of the plot. */
const HEIGHT = 44;
const MARGIN = 6;

export function mountEvidence(root: HTMLElement, store: Store, session: Session): void {
  const plot = find(root, 'svg', SVGSVGElement);
  const buttons = find(root, '.numbers', HTMLElement);
  const choice = find(root, '#evidence-choice', HTMLElement);
  const automatic = find(root, '[data-action=automatic]', HTMLButtonElement);
  automatic.addEventListener('click', () => session.pair.change({ motions: 'auto' }));
  /** The scores of the last automatic search: with a forced number there are none for the others. */
  let scores: readonly { motions: number; score: number }[] = [];

  const render = (now: State): void => {
    const { result, settings, forced } = now;
    const asked = forced ?? settings.motions;
    if (isAwaited(now)) return;
    const found = result?.segmentation;
    root.hidden = found === undefined || now.look.kind === 'objects';
    if (found === undefined || root.hidden) return;
    if (found.settings.motions === 'auto') scores = found.evidence.candidates;
    const known = scores.length > 0 ? scores : found.evidence.candidates;
    const scored = known.filter(({ motions }) => motions >= 1 && motions <= 10);
    const [shortest] = scored.toSorted((one, other) => one.score - other.score);
    const differs = found.settings.motions === 'auto' && shortest !== undefined && shortest.motions !== found.count;
    choice.hidden = !differs;
    choice.textContent = differs ? strings.otherThanShortest(found.count, shortest.motions) : '';
    const offered = Math.max(OFFERED, found.count, typeof asked === 'number' ? asked : 0, ...scored.map(({ motions }) => motions));
    automatic.setAttribute('aria-pressed', String(asked === 'auto'));
    const focused = buttons.contains(document.activeElement) ? document.activeElement?.textContent : null;
    buttons.replaceChildren(
      ...Array.from({ length: offered }, (_, k) => {
        const motions = k + 1;
        const score = scored.find((candidate) => candidate.motions === motions)?.score;
        const longer = score === undefined || shortest === undefined ? null : score - shortest.score;
        const button = element('button', String(motions), 'number');
        button.type = 'button';
        button.setAttribute('aria-pressed', String(asked === motions));
        button.classList.toggle('found', motions === found.count);
        button.setAttribute('aria-label', strings.forceNumber(motions, longer));
        if (longer !== null) button.title = strings.descriptionOf(longer);
        button.addEventListener('click', () => session.pair.forceMotions(motions));
        return button;
      }),
    );
    for (const button of buttons.querySelectorAll('button')) if (button.textContent === focused) button.focus();
    root.style.setProperty('--numbers', String(offered));
    draw(plot, scored, offered, found.count);
  };
  store.subscribe((now, before) => {
    if (now.pair !== before.pair) scores = [];
    if (now.live !== null) root.hidden = true;
    else if (now.result !== before.result || now.settings !== before.settings || now.forced !== before.forced || before.live !== null || isAwaited(before)) render(now);
  });
  if (store.get().live === null) render(store.get());
}

function draw(plot: SVGSVGElement, candidates: readonly { motions: number; score: number }[], columns: number, count: number): void {
  const scores = candidates.map(({ score }) => score);
  const [least, most] = [Math.min(...scores), Math.max(...scores)];
  const width = 40 * columns;
  plot.setAttribute('viewBox', `0 0 ${width} ${HEIGHT}`);
  // The square root shows the small differences, which decide, along with the large ones.
  const place = (score: number): number => HEIGHT - MARGIN - (HEIGHT - 2 * MARGIN) * Math.sqrt((score - least) / Math.max(most - least, 1e-9));
  const points = candidates.map(({ motions, score }) => [40 * motions - 20, place(score)] as const);
  plot.replaceChildren(
    drawn('polyline', { points: points.map((point) => point.join()).join(' '), class: 'score-line' }),
    // A line of zero length with round caps is a dot that stays round when the plot is stretched.
    ...points.map(([x, y], i) =>
      drawn('path', { d: `M${x} ${y}h0.01`, class: candidates[i]!.motions === count ? 'score found' : 'score' }),
    ),
  );
}
