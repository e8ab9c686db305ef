// The glue of the build with codecs: everything of the core, and files.

export * from './glue.js';
export { default } from './glue.js';

export function decodeImage(file: Uint8Array): unknown;
export function encodeIndexedPng(width: number, height: number, indices: Uint8Array, palette: Uint8Array): Uint8Array;
export function encodeGreyPng(width: number, height: number, grey: Uint8Array): Uint8Array;
export function encodeColourPng(width: number, height: number, pixels: Uint8Array): Uint8Array;
