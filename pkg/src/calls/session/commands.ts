// What a caller asks of a clip, checked, as messages to the core. What follows from the clip itself (locks, numbers, sizes) is checked there.

import {
  checkAttached,
  invalidOption,
  isArrayOf,
  isListOf,
  isNumber,
  isObject,
  isWhole,
  LONGEST_SIDE,
  optionsObject,
  UNLABELLED,
  unknownOf,
} from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { AnnotationMessage, ClipCommand, DeclarationMessage, DescriptionMessage } from '../messages.js';
import { taken } from '../taking.js';

const PROPAGATIONS = ['both', 'forward', 'backward', 'none', 'exact'];
const OBJECTS = `a number from 1 to ${UNLABELLED - 1}`;
const FORMS = "it needs one of 'strokes', 'mask', 'labels', 'clicks' and 'box'";

/** The clip that a command is for: its number of frames, and the size of these, 0 before it is known. */
export interface CommandTarget {
  readonly length: number;
  readonly width: number;
  readonly height: number;
}

export function annotateCommand(clip: CommandTarget, annotations: unknown): ClipCommand {
  return { type: 'annotate', annotations: annotationsOf(clip, annotations) };
}

export function clearCommand(clip: CommandTarget, given: unknown): ClipCommand {
  const { frame, object } = named('annotations', given, ['frame', 'object']);
  return { type: 'clear', frame: frameOf(clip, 'frame', frame), object: object === undefined ? undefined : objectOf('object', object) };
}

export function acceptCommand(clip: CommandTarget, frames: unknown, on: unknown): ClipCommand {
  return { type: 'accept', frames: framesOf(clip, 'frames', frames), on: flag('on', on) };
}

export function lockCommand(objects: unknown, on: unknown): ClipCommand {
  return { type: 'lock', objects: objectsOf('objects', objects), on: flag('on', on) };
}

export function describeCommand(object: unknown, description: unknown, coalesce: unknown): ClipCommand {
  return { type: 'describe', on: flag('coalesce', coalesce), ...descriptionOf('object', object, description) };
}

export function objectsCommand(type: 'merge' | 'delete', objects: unknown): ClipCommand {
  return { type, objects: objectsOf('objects', objects) };
}

export function splitCommand(clip: CommandTarget, object: unknown, frame: unknown, next: number): ClipCommand {
  if (next === 0) throw new VeroneseError('invalid-option', "option 'object': no number is left for another object");
  return { type: 'split', object: objectOf('object', object), frame: frameOf(clip, 'frame', frame), new: next };
}

export function replaceCommand(clip: CommandTarget, declaration: unknown): ClipCommand {
  const all = named('declaration', declaration, ['annotations', 'locked', 'descriptions', 'merged', 'deleted', 'accepted']);
  const { annotations = [], locked = [], descriptions = {}, merged = [], deleted = [], accepted = [] } = all;
  if (!isObject(descriptions)) throw invalidOption('descriptions', 'an object of descriptions by number of object', descriptions);
  if (!isListOf(merged, (group): group is unknown[] => Array.isArray(group))) throw invalidOption('merged', 'lists of objects', merged);
  const message: DeclarationMessage = {
    annotations: annotationsOf(clip, annotations),
    locked: objectsOf('locked', locked),
    described: Object.entries(descriptions).map(([object, description]) => descriptionOf('descriptions', Number(object), description)),
    merged: merged.map((group) => objectsOf('merged', group)),
    deleted: objectsOf('deleted', deleted),
    accepted: framesOf(clip, 'accepted', accepted),
  };
  return { type: 'replace', ...message };
}

function annotationsOf(clip: CommandTarget, annotations: unknown): AnnotationMessage[] {
  if (!isListOf(annotations, isObject)) throw invalidOption('annotations', 'annotations of frames', annotations);
  return annotations.map((annotation, at) => {
    const wrong = (reason: string) => new VeroneseError('invalid-option', `option 'annotations': number ${at}: ${reason}`);
    return annotationOf(clip, annotation, wrong);
  });
}

export function annotationOf(
  clip: CommandTarget,
  given: Record<string, unknown>,
  wrong: (reason: string) => VeroneseError,
): AnnotationMessage {
  const unknown = unknownOf(given, ['frame', 'propagate', 'object', 'strokes', 'mask', 'labels', 'own', 'clicks', 'box']);
  if (unknown !== undefined) throw wrong(`there is no ${unknown}`);
  const { frame, propagate, object, strokes, mask, labels, own = false, clicks, box } = given;
  if (!isWhole(frame, 0, clip.length - 1)) throw wrong(`'frame' must be a whole number from 0 to ${clip.length - 1}`);
  if (propagate !== undefined && !PROPAGATIONS.includes(propagate as string))
    throw wrong(`'propagate' must be one of ${PROPAGATIONS.map((word) => `'${word}'`).join(', ')}`);
  const about = { frame, propagate: propagate as string | undefined };
  const forms = [strokes, mask, labels, clicks === undefined ? box : clicks].filter((form) => form !== undefined);
  if (forms.length !== 1) throw wrong(FORMS);
  if (labels !== undefined) {
    if (object !== undefined) throw wrong("'labels' name their objects themselves: a mask of one object is 'mask'");
    if (typeof own !== 'boolean') throw wrong("'own' must be true or false");
    return { ...about, content: own ? 'given' : 'labels', labels: labelImage(clip, 'labels', labels, wrong) };
  }
  if (!isObjectNumber(object)) throw wrong(`'object' must be ${OBJECTS}`);
  const name = strokes === undefined ? 'mask' : 'strokes';
  const painted = strokes === undefined ? mask : strokes;
  if (painted === undefined) return { ...about, content: 'prompt', object, ...promptOf(clip, clicks, box, wrong) };
  const image = labelImage(clip, name, painted, wrong);
  if (image.some((label) => label !== 0 && label !== 1 && label !== UNLABELLED))
    throw wrong(`'${name}' must be 1 where the object is, 0 where it is not, and ${UNLABELLED} where that is open`);
  return { ...about, content: name, object, labels: image };
}

function labelImage({ width, height }: CommandTarget, name: string, given: unknown, wrong: (reason: string) => VeroneseError): Uint8Array {
  if (!isArrayOf(given, 'Uint8Array', 'Uint8ClampedArray')) throw wrong(`'${name}' must be a Uint8Array, one label per pixel`);
  checkAttached(name, given);
  if (width > 0 && given.length !== width * height)
    throw wrong(`'${name}' has ${given.length} labels, a frame has ${width}×${height} pixels`);
  return taken([given], false)[0] as Uint8Array;
}

function promptOf(
  clip: CommandTarget,
  clicks: unknown,
  box: unknown,
  wrong: (reason: string) => VeroneseError,
): Pick<AnnotationMessage, 'clicks' | 'box'> {
  const { width = 0, height = 0 } = clip.width > 0 ? clip : { width: LONGEST_SIDE, height: LONGEST_SIDE };
  const isPlace = (at: unknown[]) => isWhole(at[0], 0, width - 1) && isWhole(at[1], 0, height - 1);
  const isClick = (click: unknown): click is [number, number, 1 | -1] =>
    Array.isArray(click) && click.length === 3 && isPlace(click) && (click[2] === 1 || click[2] === -1);
  const isBox = (sides: unknown): sides is number[] =>
    Array.isArray(sides) &&
    sides.length === 4 &&
    isPlace(sides) &&
    isWhole(sides[2], 1, width - sides[0]) &&
    isWhole(sides[3], 1, height - sides[1]);
  if (clicks !== undefined && !isListOf(clicks, isClick))
    throw wrong("'clicks' must be a list of [x, y, 1] for pixels of the object and [x, y, -1] for others, within the frame");
  if (box !== undefined && !isBox(box)) throw wrong("'box' must be [x, y, width, height] in whole pixels, within the frame");
  return { clicks: (clicks ?? []).flatMap(([x, y, sign]) => [x, y, sign === 1 ? 1 : 0]), box: box ?? [] };
}

function descriptionOf(option: string, object: unknown, description: unknown): DescriptionMessage {
  const { name = '', class: own = '', colour } = named('description', description, ['name', 'class', 'colour']);
  if (typeof name !== 'string') throw invalidOption('name', 'a text', name);
  if (typeof own !== 'string') throw invalidOption('class', 'a text', own);
  const isLevel = (level: unknown): level is number => isWhole(level, 0, 255);
  if (colour !== undefined && !(isListOf(colour, isLevel) && colour.length === 3))
    throw invalidOption('colour', '[red, green, blue] from 0 to 255', colour);
  return { object: objectOf(option, object), name, class: own, colour };
}

/** The entries of an object, all of them known. */
function named(option: string, given: unknown, known: readonly string[]): Record<string, unknown> {
  if (!isObject(given)) throw invalidOption(option, 'an object', given);
  const unknown = unknownOf(given, known);
  if (unknown !== undefined) throw new VeroneseError('invalid-option', `option '${option}': there is no ${unknown}`);
  return { ...optionsObject(given) };
}

/** The frame that a command is about; undefined if it is about more, or about objects. */
export function frameOfCommand(command: ClipCommand): number | undefined {
  if (command.type === 'annotate') return command.annotations[0]?.frame;
  return command.type === 'clear' || command.type === 'split' ? command.frame : undefined;
}

/** The objects that a command may make. */
export function objectsOfCommand(command: ClipCommand): number[] {
  if (command.type === 'split') return [command.new];
  const annotations = command.type === 'annotate' || command.type === 'replace' ? command.annotations : [];
  return annotations.flatMap(({ object, labels }) => (object !== undefined ? [object] : [...new Set(labels)]));
}

export function frameOf({ length }: Pick<CommandTarget, 'length'>, option: string, frame: unknown): number {
  if (isWhole(frame, 0, length - 1)) return frame;
  const found = isNumber(frame) ? frame : `a value of type ${typeof frame}`;
  throw new VeroneseError('invalid-option', `option '${option}': there is no frame ${found} in a clip of ${length} frames`);
}

function framesOf(clip: CommandTarget, option: string, frames: unknown): number[] {
  if (!Array.isArray(frames)) throw invalidOption(option, 'a list of frames', frames);
  return [...(frames as unknown[])].map((frame) => frameOf(clip, option, frame));
}

function objectOf(option: string, object: unknown): number {
  if (isObjectNumber(object)) return object;
  throw invalidOption(option, OBJECTS, object);
}

function objectsOf(option: string, objects: unknown): Uint8Array {
  if (!Array.isArray(objects)) throw invalidOption(option, 'a list of objects', objects);
  return Uint8Array.from([...(objects as unknown[])], (object) => objectOf(option, object));
}

function isObjectNumber(value: unknown): value is number {
  return isWhole(value, 1, UNLABELLED - 1);
}

function flag(option: string, value: unknown): boolean {
  if (typeof value === 'boolean') return value;
  throw invalidOption(option, 'true or false', value);
}
