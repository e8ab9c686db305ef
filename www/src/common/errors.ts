//! Errors that the page raises. Like the package's, they have a stable code and a sentence; they use the package's codes where they fit.

export class PageError extends Error {
  override readonly name = 'PageError';

  constructor(
    readonly code: string,
    sentence: string,
  ) {
    super(sentence);
  }
}

/** The code of an error; `unexpected` if it comes from neither the package nor the page. */
export function codeOf(error: unknown): string {
  return error instanceof Error && 'code' in error && typeof error.code === 'string' ? error.code : 'unexpected';
}

/** Whether the browser has no room left for the page. */
export function isStorageFull(error: unknown): boolean {
  return error instanceof Error && error.name === 'QuotaExceededError';
}

export function sentenceOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
