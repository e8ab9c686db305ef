// Reads a labelling configuration of Label Studio.

import { DOMParser, onWarningStopParsing } from '@xmldom/xmldom';
import { Refusal } from './http.mjs';

/** Most characters: the largest templates of Label Studio have some thousands. */
const LARGEST = 64 * 1024;

/**
 * The targets of annotation: the key of a `video` and its `frameRate` as it is written, or the `keys` of two images, of which the one that is
 * painted on is the first frame. `labels` in their order; `fromName` and `toName` are what a result refers to.
 */
export function readConfig(config) {
  if (typeof config !== 'string' || config.length > LARGEST) throw refusal(`must be a text of at most ${LARGEST} characters`);
  const all = parsed(config);
  const [tool] = [...all('VideoRectangle'), ...all('BrushLabels')];
  if (!tool) throw refusal('has neither BrushLabels nor a VideoRectangle');
  const [fromName, toName] = [value(tool, 'name'), value(tool, 'toName')];
  const targets = [...all('Video'), ...all('Image')];
  const target = targets.find((tag) => tag.getAttribute('name') === toName);
  if (!target) throw refusal(`has no Video or Image named '${toName}'`);
  const groups = target.tagName === 'Video' ? all('Labels').filter((tag) => tag.getAttribute('toName') === toName) : [tool];
  const labels = groups.flatMap((group) => Array.from(group.getElementsByTagName('Label'), (label) => value(label, 'value')));
  const found = { fromName, toName, labels };
  if (target.tagName === 'Video') {
    if (labels.length === 0) throw refusal(`has no Labels for the video '${toName}'`);
    return { ...found, video: keyOf(target), frameRate: target.getAttribute('frameRate') ?? undefined };
  }
  const other = all('Image').find((image) => image !== target);
  if (!other) throw refusal('needs two Image tags, the brush on the first frame');
  return { ...found, keys: [target, other].map(keyOf) };
}

/** A function that lists the tags of a name. */
function parsed(config) {
  try {
    const document = new DOMParser({ onError: onWarningStopParsing }).parseFromString(config, 'text/xml');
    return (name) => Array.from(document.getElementsByTagName(name));
  } catch (error) {
    throw refusal(`is not XML: ${error.message.slice(0, 200)}`);
  }
}

function keyOf(tag) {
  return value(tag, 'value').replace(/^\$/, '');
}

function value(tag, name) {
  const text = tag.getAttribute(name);
  if (!text) throw refusal(`has a ${tag.tagName} without ${name}`);
  return text;
}

function refusal(what) {
  return new Refusal(422, 'invalid-input', `the labelling configuration ${what}`);
}
