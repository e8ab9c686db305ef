// The entry `veronese/formats`: masks in the forms that annotation tools read and write. Nothing is loaded.

export { encode } from './encode.js';
export { readAnnotations } from './reading/annotations.js';
export { readMask } from './reading/mask.js';
