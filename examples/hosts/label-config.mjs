// What a labelling configuration of Label Studio says.

import { DOMParser, onWarningStopParsing } from '@xmldom/xmldom';
import { Refusal } from './http.mjs';

/** Most characters: the largest templates of Label Studio have some thousands. */
const LARGEST = 64 * 1024;

/**
 * The brush and what it paints on, the names of its labels, and the two images, of which the one that is painted on is the first
 * frame.
 */
export function readConfig(config) {
  const all = parsed(config);
  const [brush] = all('BrushLabels');
  if (!brush) throw refusal('has no BrushLabels');
  const [fromName, toName] = [value(brush, 'name'), value(brush, 'toName')];
  const images = all('Image');
  const painted = images.find((image) => image.getAttribute('name') === toName);
  const other = images.find((image) => image !== painted);
  if (!painted || !other) throw refusal('needs two Image tags, the brush on the first frame');
  const labels = Array.from(brush.getElementsByTagName('Label'), (label) => value(label, 'value'));
  return { fromName, toName, labels, keys: [painted, other].map((image) => value(image, 'value').replace(/^\$/, '')) };
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
