// W3C Web Annotation: one annotation per label, its target an SVG path in pixels of the image, filled by the even-odd rule.

import type { FormatMeta, WebAnnotation } from '../../types/formats.js';
import { checkedOptions, imageOf, masksOf } from './input.js';
import { Outlines, type Ring } from './outline.js';

export function encodeWebAnnotation(
  labels: Uint8Array,
  width: number,
  height: number,
  meta: FormatMeta = {},
  options?: { tolerance?: number },
): WebAnnotation[] {
  const { tolerance } = checkedOptions(options, []);
  const masks = masksOf(labels, width, height, meta);
  const rings = new Outlines(tolerance).rings({ masks, width, height });
  return masks.map((mask, at) => ({
    '@context': 'http://www.w3.org/ns/anno.jsonld',
    id: `#motion-${mask.label}`,
    type: 'Annotation',
    body: [{ type: 'TextualBody', purpose: 'tagging', value: mask.name }],
    target: {
      source: imageOf(meta),
      selector: {
        type: 'SvgSelector',
        value: `<svg xmlns="http://www.w3.org/2000/svg"><path fill-rule="evenodd" d="${(rings[at] as Ring[]).map(path).join('')}"/></svg>`,
      },
    },
  }));
}

function path(ring: Ring): string {
  return `M${ring.join(' ')}Z`;
}
