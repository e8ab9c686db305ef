//! The evidence for the number of motions: how long the description of both frames is with each number. The number found need not be that with
//! the shortest: then a sentence explains it.

import type { Segmentation } from 'veronese';
import type { VNode } from 'preact';
import { strings } from '../common/strings.js';

/** Units of the plot: the width of a number, its height, and the room above and below. */
const [WIDTH, HEIGHT, MARGIN] = [40, 44, 6];
/** The paper's limit. */
const MOST_MOTIONS = 10;

export function Evidence({ segmentation: { count, evidence, settings } }: { segmentation: Segmentation }): VNode | null {
  const scored = evidence.candidates.filter(({ motions }) => motions >= 1 && motions <= MOST_MOTIONS);
  const [shortest] = scored.toSorted((one, other) => one.score - other.score);
  if (shortest === undefined) return null;
  const numbers = Array.from({ length: Math.max(count, ...scored.map(({ motions }) => motions)) }, (_, k) => k + 1);
  const least = shortest.score;
  const range = Math.max(Math.max(...scored.map(({ score }) => score)) - least, 1e-9);
  // The square root shows the small differences, which decide, along with the large ones.
  const points = scored.map(({ motions, score }) => [WIDTH * (motions - 0.5), HEIGHT - MARGIN - (HEIGHT - 2 * MARGIN) * Math.sqrt((score - least) / range)] as const);
  return (
    <section id="evidence" class="evidence" aria-labelledby="evidence-title">
      <h3 id="evidence-title">Number of motions</h3>
      <p class="help faint">The lower the point of a number, the shorter the description of both frames with so many motions.</p>
      <div class="plot" style={{ '--numbers': numbers.length }}>
        <svg viewBox={`0 0 ${WIDTH * numbers.length} ${HEIGHT}`} preserveAspectRatio="none" aria-hidden="true">
          <polyline class="score-line" points={points.map((point) => point.join()).join(' ')} />
          {/* A line of zero length with round caps is a dot that stays round when the plot is stretched. */}
          {points.map(([x, y], k) => (
            <path class={scored[k]!.motions === count ? 'score found' : 'score'} d={`M${x} ${y}h0.01`} />
          ))}
        </svg>
        <ol class="numbers">
          {numbers.map((motions) => {
            const score = scored.find((one) => one.motions === motions)?.score;
            return (
              <li class={motions === count ? 'number found' : 'number'} title={score === undefined ? undefined : strings.descriptionOf(score - least)}>
                {motions}
                {score !== undefined && <span class="visually-hidden">: {strings.descriptionOf(score - least)}</span>}
              </li>
            );
          })}
        </ol>
      </div>
      {settings.motions === 'auto' && shortest.motions !== count && <p class="help faint">{strings.otherThanShortest(count, shortest.motions)}</p>}
    </section>
  );
}
