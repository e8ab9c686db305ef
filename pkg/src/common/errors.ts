// One error class for everything that can go wrong, with a stable code.

import type { ErrorCode } from '../../types/index.js';

export class VeroneseError extends Error {
  readonly code: ErrorCode;

  constructor(code: ErrorCode, message: string, options?: ErrorOptions) {
    super(message, options);
    this.name = 'VeroneseError';
    this.code = code;
  }
}

/** An error on its way from a worker: its class does not survive the copy. */
export interface ErrorMessage {
  code: ErrorCode;
  message: string;
}

export function errorMessage(thrown: unknown): ErrorMessage {
  const { code, message } = veroneseError(thrown);
  return { code, message };
}

/** Anything thrown, as an error of ours. What is not known is `internal`, with its own message. */
export function veroneseError(thrown: unknown): VeroneseError {
  if (thrown instanceof VeroneseError) return thrown;
  if (isFailure(thrown)) return new VeroneseError(thrown.code, thrown.message);
  const message = thrown instanceof Error ? `${thrown.name}: ${thrown.message}` : String(thrown);
  return new VeroneseError('internal', message, { cause: thrown });
}

/** An error thrown by the Rust side: a plain `Error` of our name with a code. */
export function isFailure(thrown: unknown): thrown is Error & { code: ErrorCode } {
  return thrown instanceof Error && thrown.name === 'VeroneseError' && 'code' in thrown && typeof thrown.code === 'string';
}

export function cancelled(signal?: AbortSignal): VeroneseError {
  return new VeroneseError('cancelled', 'the call was cancelled', { cause: signal?.reason });
}
