// Loaded by the element when it is needed: clips, and masks as files for a form. One file, so that it is one request.

export { ElementClip } from './clip.js';
export { fileOf, packed } from './masks.js';
export { Zoom } from './zoom.js';
