// Input and report of every application here: a clip that arrives as a property, and its first labels.

import { first, second } from './frames.js';

export const frames = [first, second];

export function ended({ target, detail }) {
  const attributes = { motions: target.getAttribute('motions'), quality: target.getAttribute('quality'), grouped: target.hasAttribute('grouped') };
  globalThis.outcome = { objects: detail.objects.length, labels: Array.from(target.labels()).join(''), attributes };
}

export function failed({ detail: { code, message } }) {
  globalThis.outcome = { error: `${code}: ${message}` };
}
