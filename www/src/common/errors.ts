//! Errors that the page itself raises. They look like the package's, a stable code and a sentence, and use its codes where they fit.

export class PageError extends Error {
  override readonly name = 'PageError';

  constructor(
    readonly code: string,
    sentence: string,
  ) {
    super(sentence);
  }
}

/** The code of any error thrown at us; the package's and the page's carry one. */
export function codeOf(error: unknown): string {
  return error instanceof Error && 'code' in error && typeof error.code === 'string' ? error.code : 'unexpected';
}

export function sentenceOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
