// CVAT 1.1: images with their shapes, or a video's tracks, whose shapes have the number of a frame and no image.

import { parseXml, XmlElement } from '@rgrove/parse-xml';
import { invalidInput } from '../../common/checks.js';
import {
  addTo,
  checkBox,
  checkSize,
  type Context,
  type Drawing,
  frameOfShapes,
  known,
  polygonOf,
  quoted,
  type ReadFrame,
  type Shape,
  shapesOf,
  stemOf,
  turnedBox,
  Unnumbered,
  within,
} from './frame.js';

/** Elements without pixels. */
const REMARKS = ['attribute', 'tag'];

/** Images, and frames of a video, without shapes are left out: files also list those at which nobody has looked. */
export function readCvat(text: string, file: string, context: Context): ReadFrame[] {
  const root = parsed(text);
  if (root.name !== 'annotations') throw invalidInput('it is no annotation of CVAT: its element is not <annotations>');
  const tracks = childrenOf(root, 'track');
  const images = childrenOf(root, 'image').flatMap((image) => framesOf(image, file, context));
  return tracks.length > 0 ? [...images, ...videoOf(root, tracks, file, context)] : images;
}

function parsed(text: string): XmlElement {
  let root: XmlElement | null;
  try {
    ({ root } = parseXml(text));
  } catch (thrown) {
    if (thrown instanceof RangeError) throw thrown;
    throw invalidInput(`it is not XML: ${(thrown as Error).message.split('\n')[0]}`);
  }
  if (!root) throw invalidInput('it has no element');
  return root;
}

function childrenOf({ children }: XmlElement, name?: string): XmlElement[] {
  return children.filter((child): child is XmlElement => child instanceof XmlElement && (name === undefined || child.name === name));
}

type Layered = Shape & { z: number };

function framesOf(image: XmlElement, file: string, context: Context): ReadFrame[] {
  const unnumbered = new Unnumbered();
  const objectOf = (element: XmlElement) => {
    const { label, group_id: group = '0' } = element.attributes;
    const track = childrenOf(element, 'attribute').find(({ attributes }) => attributes['name'] === 'track_id')?.text;
    if (track !== undefined) return known(`track ${track}`, numberOr(track), label);
    return group === '0' ? known(unnumbered.keyOf(label), undefined, label) : known(`group ${group} ${label}`, numberOr(group), label);
  };
  const { name, width, height } = image.attributes;
  const place = `image ${quoted(name)}`;
  const shapes = childrenOf(image).flatMap((element, at) =>
    REMARKS.includes(element.name) ? [] : layered(`${place}, shape ${at + 1}`, element, () => objectOf(element)),
  );
  if (shapes.length === 0) return [];
  const size = within(place, () => checkSize(number(width), number(height), 'an image'));
  return [within(place, () => frameOf({ name: stemOf(name), file, ...size }, shapes, context))];
}

function videoOf(root: XmlElement, tracks: readonly XmlElement[], file: string, context: Context): ReadFrame[] {
  const [extent] = childrenOf(root, 'meta').flatMap((meta) => descendantsOf(meta, 'original_size'));
  const [width, height] = ['width', 'height'].map((side) => number(extent && childrenOf(extent, side)[0]?.text));
  const size = checkSize(width, height, 'the video, in <original_size>,');
  const frames = new Map<number, Layered[]>();
  for (const track of tracks) {
    const { id, label } = track.attributes;
    for (const element of childrenOf(track)) {
      if (element.attributes['outside'] === '1' || REMARKS.includes(element.name)) continue;
      const index = number(element.attributes['frame']);
      if (!Number.isInteger(index) || index < 0)
        throw invalidInput(`track ${quoted(id)}: the frame of a shape must be a whole number from 0`);
      const object = () => known(`track ${id}`, numberOr(id), label);
      addTo(frames, index, ...layered(`track ${quoted(id)}, frame ${index}`, element, object));
    }
  }
  return [...frames]
    .sort(([a], [b]) => a - b)
    .map(([index, shapes]) => frameOf({ name: context.nameOf(index), file, ...size }, shapes, context));
}

/** Of a task, a job, or the tasks of a project. */
function descendantsOf(element: XmlElement, name: string): XmlElement[] {
  return childrenOf(element).flatMap((child) => (child.name === name ? [child] : descendantsOf(child, name)));
}

function frameOf(frame: Omit<ReadFrame, 'objects' | 'draw'>, shapes: readonly Layered[], context: Context): ReadFrame {
  return frameOfShapes(
    frame,
    [...shapes].sort((a, b) => a.z - b.z),
    context,
  );
}

function layered(place: string, element: XmlElement, object: Parameters<typeof shapesOf>[2]): Layered[] {
  const z = number(element.attributes['z_order']) || 0;
  return shapesOf(place, () => [drawing(element)], object).map((shape) => ({ ...shape, z }));
}

function drawing({ name, attributes }: XmlElement): Drawing {
  const { points = '', rle = '', rotation } = attributes;
  const numbers = (...parts: string[]) => parts.map((part) => number(attributes[part])) as [number, number, number, number];
  const angle = number(rotation) || 0;
  if (name === 'polygon') return polygonOf(points.trim() === '' ? [] : points.split(/[,;]/).map(number));
  if (name === 'box') {
    const [left, top, right, bottom] = numbers('xtl', 'ytl', 'xbr', 'ybr');
    return turnedBox([left, top, right - left, bottom - top], angle, [(left + right) / 2, (top + bottom) / 2]);
  }
  if (name === 'ellipse') return { draw: (canvas, label) => canvas.ellipse(numbers('cx', 'cy', 'rx', 'ry'), label, angle) };
  if (name !== 'mask') return { leftOut: `<${name}> elements` };
  return {
    draw: (canvas, label) => canvas.rows(rle.split(',').map(number), checkBox(numbers('left', 'top', 'width', 'height'), canvas), label),
  };
}

/** The number that a text is, or the text. */
function numberOr(text: string | undefined): number | string | undefined {
  return Number.isNaN(number(text)) ? text : number(text);
}

/** Not a number where there is none; `Number` takes empty text for 0. */
function number(text: string | undefined): number {
  return text?.trim() ? Number(text) : NaN;
}
