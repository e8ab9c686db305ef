// Reads a labelling configuration of Label Studio.

import { DOMParser, onWarningStopParsing } from '@xmldom/xmldom';
import { Refusal } from './http.mjs';

/** Most characters: the largest templates of Label Studio have some thousands. */
const LARGEST = 64 * 1024;

/**
 * The `keys` of two images, of which the one that is painted on is the first frame. `labels` in their order; `fromName` and `toName` are what a
 * result refers to.
 */
export function readConfig(config) {
  if (typeof config !== 'string' || config.length > LARGEST) throw refusal(`must be a text of at most ${LARGEST} characters`);
  const all = parsed(config);
  const [tool] = all('BrushLabels');
  if (!tool) throw refusal('has no BrushLabels');
  const [fromName, toName] = [value(tool, 'name'), value(tool, 'toName')];
  const target = all('Image').find((image) => image.getAttribute('name') === toName);
  if (!target) throw refusal(`has no Image named '${toName}'`);
  const labels = Array.from(tool.getElementsByTagName('Label'), (label) => value(label, 'value'));
  const other = all('Image').find((image) => image !== target);
  if (!other) throw refusal('needs two Image tags, the brush on the first frame');
  return { fromName, toName, labels, keys: [target, other].map(keyOf) };
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
