// Reads a labelling configuration of Label Studio.

import { DOMParser, onWarningStopParsing } from '@xmldom/xmldom';
import { Refusal } from './http.mjs';

/** Most characters: the largest templates of Label Studio have some thousands. */
const LARGEST = 64 * 1024;

/**
 * The targets of annotation: on a video, or on the first of two images. `labels` in their order; `fromName` and `toName` are what a
 * result refers to.
 */
export function readConfig(config) {
  const all = parsed(config);
  const [box] = all('VideoRectangle');
  return box ? videoOf(all, box) : pairOf(all);
}

/** The boxes, the names of their labels, the key of the video in a task, and its `frameRate` as it is written. */
function videoOf(all, box) {
  const [fromName, toName] = [value(box, 'name'), value(box, 'toName')];
  const video = all('Video').find((tag) => tag.getAttribute('name') === toName);
  if (!video) throw refusal(`has no Video named '${toName}' for its VideoRectangle`);
  const labels = all('Labels').filter((tag) => tag.getAttribute('toName') === toName).flatMap(labelsIn);
  if (labels.length === 0) throw refusal(`has no Labels for the video '${toName}'`);
  const frameRate = video.getAttribute('frameRate') ?? video.getAttribute('framerate') ?? undefined;
  return { fromName, toName, labels, video: keyOf(video), ...(frameRate && { frameRate }) };
}

/**
 * The brush and what it paints on, the names of its labels, and the keys of the two images, of which the one that is painted on is the
 * first frame.
 */
function pairOf(all) {
  const [brush] = all('BrushLabels');
  if (!brush) throw refusal('has neither BrushLabels nor a VideoRectangle');
  const [fromName, toName] = [value(brush, 'name'), value(brush, 'toName')];
  const images = all('Image');
  const painted = images.find((image) => image.getAttribute('name') === toName);
  const other = images.find((image) => image !== painted);
  if (!painted || !other) throw refusal('needs two Image tags, the brush on the first frame');
  return { fromName, toName, labels: labelsIn(brush), keys: [painted, other].map(keyOf) };
}

function labelsIn(tag) {
  return Array.from(tag.getElementsByTagName('Label'), (label) => value(label, 'value'));
}

function keyOf(tag) {
  return value(tag, 'value').replace(/^\$/, '');
}

/** A function that lists the tags of a name. */
function parsed(config) {
  if (typeof config !== 'string') throw refusal('must be text');
  if (config.length > LARGEST) throw refusal(`has more than ${LARGEST} characters`);
  try {
    const document = new DOMParser({ onError: onWarningStopParsing }).parseFromString(config, 'text/xml');
    return (name) => Array.from(document.getElementsByTagName(name));
  } catch (error) {
    throw refusal(`is not XML: ${error.message.slice(0, 200)}`);
  }
}

function value(tag, name) {
  const text = tag.getAttribute(name);
  if (!text) throw refusal(`has a ${tag.tagName} without ${name}`);
  return text;
}

function refusal(what) {
  return new Refusal(422, 'invalid-input', `the labelling configuration ${what}`);
}
