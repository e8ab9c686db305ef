//! One motion between two frames: its share and what it is in words, its matrix in several notations, and how it becomes an object.

import type { Segmentation } from 'veronese';
import type { VNode } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { strings } from '../common/strings.js';
import { colourOf, cssColour } from '../drawing/palette.js';
import { centreOf, partsOf, visibleParts } from '../result/describe.js';
import { NOTATIONS } from '../result/matrices.js';
import type { Session } from '../session/session.js';
import type { LoadedFrame } from '../state/pair.js';
import type { Store } from '../state/state.js';
import { copyText } from './clipboard.js';
import { drawThumbnail } from './thumbnail.js';

interface Given {
  readonly frame: LoadedFrame;
  readonly segmentation: Segmentation;
  readonly motion: Segmentation['motions'][number];
  readonly store: Store;
  readonly session: Session;
}

export function MotionRow({ frame, segmentation, motion, store, session }: Given): VNode {
  const { label, matrix, bbox, share } = motion;
  const name = strings.motionName(label);
  const parts = visibleParts(partsOf(matrix, centreOf(segmentation, label)), Math.hypot(bbox[2], bbox[3]) / 2);
  const thumbnail = useRef<HTMLCanvasElement>(null);
  useLayoutEffect(() => {
    if (thumbnail.current !== null && bbox[2] > 0 && bbox[3] > 0) drawThumbnail(thumbnail.current, frame, bbox);
  }, [motion]);
  const take = async (): Promise<void> => {
    const selected = await session.objects.take(label);
    if (selected !== null) store.look({ selected, motions: false });
  };
  return (
    <li class="motion" data-motion={label} style={{ '--colour': cssColour(colourOf(label)) }}>
      <div class="motion-head">
        {label > 0 && <canvas ref={thumbnail} class="thumbnail" width="72" height="56" aria-hidden="true" />}
        <strong>{name}</strong>
        <span class="motion-share">{strings.percent(share)}</span>
      </div>
      <p class="motion-words">
        <svg
          class="direction"
          viewBox="0 0 20 20"
          width="18"
          height="18"
          aria-hidden="true"
          hidden={parts.right === 0 && parts.down === 0}
          style={{ rotate: `${Math.atan2(parts.down, parts.right)}rad` }}
        >
          <path d="M3 10h14M11 4l6 6-6 6" />
        </svg>
        <span class="words">{strings.displacement(parts)}</span>
      </p>
      <div class="motion-actions">
        {label > 0 && (
          <button type="button" class="button small quiet" data-action="take" title={strings.takeOf(name)} onClick={() => void take()}>
            Make an object
          </button>
        )}
        <details class="more">
          <summary>More</summary>
          <p class="motion-facts faint">{[strings.motion(parts), strings.residual(motion.residual), ...fellowsOf(motion, segmentation)].join(' · ')}</p>
          <table class="matrix">
            <tbody>
              {[matrix.slice(0, 3), matrix.slice(3, 6)].map((row) => (
                <tr>
                  {row.map((entry) => (
                    <td>{strings.entry(entry)}</td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
          <p class="faint">Copy the motion as</p>
          <div class="copies">
            {NOTATIONS.map(({ title, write }) => (
              <button type="button" class="button small quiet" onClick={() => copyText(write(matrix), strings.copied(title, name), session)}>
                {title}
              </button>
            ))}
          </div>
        </details>
      </div>
    </li>
  );
}

/** The other motions of its surface. */
function fellowsOf({ group, label }: Given['motion'], { motions }: Segmentation): string[] {
  const fellows = motions.filter((other) => other.group === group && other.label !== label);
  return fellows.length > 0 ? [strings.groupWith(fellows.map((other) => other.label))] : [];
}
