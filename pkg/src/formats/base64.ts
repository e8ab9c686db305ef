// Base64. Written without the host's help: Node and browsers have different calls for it.

import { invalidInput } from '../common/checks.js';

const DIGITS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/';

export function base64(bytes: Uint8Array): string {
  const parts: string[] = [];
  for (let at = 0; at < bytes.length; at += 3) {
    const [first = 0, second = 0, third = 0] = bytes.subarray(at, at + 3);
    const bits = (first << 16) | (second << 8) | third;
    const digits = [18, 12, 6, 0].map((shift) => DIGITS.charAt((bits >> shift) & 63)).join('');
    const padding = Math.max(0, at + 3 - bytes.length);
    parts.push(digits.slice(0, 4 - padding) + '='.repeat(padding));
  }
  return parts.join('');
}

/** Throws `invalid-input`. */
export function fromBase64(text: string): Uint8Array {
  try {
    return Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  } catch {
    throw invalidInput('a text is not base64');
  }
}
