// Results on stdout, errors and progress on stderr.

import { VeroneseError, veroneseError } from '../common/errors.js';
import type { Io, Stderr } from './io.js';

/** Nobody reads the results any more: the end of the work, and no error. */
export class ClosedPipe extends Error {}

export function print({ stdout }: Io, text: string): Promise<void> {
  return new Promise((resolve, reject) => {
    const failed = (error: NodeJS.ErrnoException) => {
      reject(
        error.code === 'EPIPE' ? new ClosedPipe() : new VeroneseError('write-failed', `the result cannot be printed: ${error.message}`),
      );
    };
    stdout.once('error', failed);
    stdout.write(text, (error) => {
      if (error) return failed(error);
      stdout.off('error', failed);
      resolve();
    });
  });
}

/** Colours of a terminal, by their numbers in its escape sequences. */
const BOLD = 1;
const KINDS = { error: 31, warning: 33, note: 36 } as const;

/** How headings are printed. */
export function heading({ stdout }: Io): (text: string) => string {
  return (text) => (stdout.hasColors?.() ? coloured(text, BOLD) : text);
}

function coloured(text: string, ...numbers: number[]): string {
  return `\u001b[${numbers.join(';')}m${text}\u001b[0m`;
}

/** One line on stderr, whatever the message looks like. */
function say(stderr: Stderr, kind: keyof typeof KINDS, sentence: string): void {
  const begin = stderr.hasColors?.() ? `veronese: ${coloured(`${kind}:`, BOLD, KINDS[kind])}` : `veronese: ${kind}:`;
  stderr.write(`${begin} ${sentence.replace(/\s+/g, ' ').trim()}\n`);
}

/** Prints the error that ended the work. */
export function complain({ stderr }: Io, thrown: unknown): void {
  const { code, message } = veroneseError(thrown);
  say(stderr, 'error', `${code}: ${message}`);
}

/** Prints what does not end it. */
export function warn({ stderr }: Io, sentence: string): void {
  if (!stderr.quiet) say(stderr, 'warning', sentence);
}

/** Prints what was assumed. */
export function note({ stderr }: Io, { message }: { message: string }): void {
  if (!stderr.quiet) say(stderr, 'note', message);
}

export interface Tally {
  done: number;
  skipped: number;
  failed: number;
}

/** How often the bar is drawn at most, milliseconds. */
const INTERVAL = 100;
const WIDTH = 24;

/**
 * A line that is drawn over and over, only where a person looks: on a terminal. `total`: the number of pairs (or of `unit`), where it is
 * known. `title`: what is done with them.
 */
export function progressBar(total: number | undefined, stream: Stderr, { unit = 'pairs', title = '', now = () => performance.now() } = {}) {
  const started = now();
  let drawn = -Infinity;
  return {
    update(tally: Tally): void {
      const time = now();
      if (!stream.isTTY || stream.quiet || time - drawn < INTERVAL) return;
      drawn = time;
      stream.write(`\r\u001b[K${title}${line(tally, total, (time - started) / 1000, unit)}`);
    },
    /** Takes the line away, for what is to be read there. */
    clear(): void {
      if (drawn > -Infinity) stream.write('\r\u001b[K');
    },
  };
}

function line({ done, skipped, failed }: Tally, total: number | undefined, seconds: number, unit: string): string {
  const finished = done + skipped + failed;
  const rate = seconds > 0 ? done / seconds : 0;
  const parts = [`${finished}${total === undefined ? '' : ` of ${total}`} ${unit}`];
  if (skipped > 0) parts.push(`${skipped} done before`);
  if (failed > 0) parts.push(`${failed} failed`);
  if (rate > 0) parts.push(`${rate.toFixed(1)} ${unit}/s`);
  if (total !== undefined && rate > 0) parts.push(`${Math.ceil((total - finished) / rate)} s left`);
  if (total === undefined || total === 0) return parts.join(', ');
  const full = Math.round((WIDTH * finished) / total);
  return `[${'#'.repeat(full)}${'.'.repeat(WIDTH - full)}] ${parts.join(', ')}`;
}
