// "CVAT for images 1.1": images with a <mask> or <polygon> per part. Objects of a clip are groups, because images have no tracks.

import { type Encoder, idOf } from './frames.js';
import type { Mask } from './masks.js';
import type { Settings } from './metadata.js';
import { Outlines, points, type Ring } from './outline.js';
import { rowRuns } from './runs.js';

const ENTITIES: Readonly<Record<string, string>> = {
  '&': '&amp;',
  '<': '&lt;',
  '>': '&gt;',
  '"': '&quot;',
  '\n': '&#10;',
  '\t': '&#9;',
  '\r': '&#13;',
};

export function cvatImages(file: string, shape: 'mask' | 'polygon') {
  return ({ one, classes, tracked, tolerance }: Settings): Encoder => {
    const outlines = new Outlines(tolerance, one ? 'image' : 'clip');
    const names = new Set(classes);
    const elements: string[] = [];
    return {
      add(frame) {
        const { index, image, width, height, masks } = frame;
        for (const { name } of masks) names.add(name);
        elements.push(`  <image id="${index}" name="${escaped(image)}" width="${width}" height="${height}">`);
        if (shape === 'mask') for (const mask of masks) elements.push(maskElement(mask, tracked));
        else for (const element of polygonElements(masks, outlines.bridged(frame), tracked)) elements.push(element);
        elements.push('  </image>');
      },
      finish: ({ length }) => [{ name: file, content: cvatDocument('annotation', length, names, [], elements) }],
    };
  };
}

/** The whole document. `task` are further elements of the task. */
export function cvatDocument(
  mode: 'annotation' | 'interpolation',
  size: number,
  names: Iterable<string>,
  task: readonly string[],
  elements: readonly string[],
): string {
  return [
    '<?xml version="1.0" encoding="utf-8"?>',
    '<annotations>',
    '  <version>1.1</version>',
    '  <meta>',
    '    <task>',
    `      <size>${size}</size>`,
    `      <mode>${mode}</mode>`,
    '      <labels>',
    ...Array.from(new Set(names), (name) => `        <label><name>${escaped(name)}</name><attributes></attributes></label>`),
    '      </labels>',
    ...task.map((element) => `      ${element}`),
    '    </task>',
    '  </meta>',
    ...elements,
    '</annotations>',
    '',
  ].join('\n');
}

function maskElement({ label, name, left, top, width, height, pixels }: Mask, grouped: boolean): string {
  const box = `left="${left}" top="${top}" width="${width}" height="${height}"`;
  const rest = `source="auto" occluded="0" rle="${rowRuns(pixels).join(', ')}" ${box} z_order="0"${groupOf(label, grouped)}`;
  return `    <mask label="${escaped(name)}" ${rest}></mask>`;
}

/** One polygon for each connected part, all of one group. */
function polygonElements(masks: readonly Mask[], rings: readonly Ring[][], grouped: boolean): string[] {
  return masks.flatMap(({ label, name }, at) => {
    const parts = rings[at] as Ring[];
    const group = groupOf(label, grouped || parts.length > 1);
    return parts.map((ring) => {
      const rest = `source="auto" occluded="0" points="${cvatPoints(ring)}" z_order="0"${group}`;
      return `    <polygon label="${escaped(name)}" ${rest}></polygon>`;
    });
  });
}

/** 0 would be no group. */
function groupOf(label: number, grouped: boolean): string {
  return grouped ? ` group_id="${idOf(label)}"` : '';
}

/** The vertices of a polygon. */
export function cvatPoints(ring: Ring): string {
  return points(ring)
    .map((point) => point.map((value) => value.toFixed(2)).join())
    .join(';');
}

/** Text inside XML attributes and elements. What XML 1.0 cannot hold at all is left out. */
export function escaped(text: string): string {
  return text
    .replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, '')
    .replace(/[&<>"\n\t\r]/g, (character) => ENTITIES[character] as string);
}
