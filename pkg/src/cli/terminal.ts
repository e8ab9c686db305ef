// Results on stdout, errors and progress on stderr.

import { VeroneseError, veroneseError } from '../common/errors.js';
import type { Io, Stderr } from './io.js';

export function print({ stdout }: Io, text: string): Promise<void> {
  return new Promise((resolve, reject) => {
    const failed = (error: Error) => {
      reject(new VeroneseError('write-failed', `the result cannot be printed: ${error.message}`));
    };
    stdout.once('error', failed);
    stdout.write(text, (error) => {
      if (error) return failed(error);
      stdout.off('error', failed);
      resolve();
    });
  });
}

/** One line on stderr, whatever the error's message looks like. */
export function complain({ stderr }: Io, thrown: unknown): void {
  const { code, message } = veroneseError(thrown);
  stderr.write(`veronese: error: ${code}: ${message.replace(/\s+/g, ' ').trim()}\n`);
}

/** As {@link complain}, of what does not end the work. */
export function warn({ stderr }: Io, sentence: string): void {
  stderr.write(`veronese: warning: ${sentence}\n`);
}

/** One line on stderr of what was assumed. */
export function note({ stderr }: Io, { message }: { message: string }): void {
  stderr.write(`veronese: note: ${message.replace(/\s+/g, ' ').trim()}\n`);
}

export interface Tally {
  done: number;
  skipped: number;
  failed: number;
}

/** How often the bar is drawn at most, milliseconds. */
const INTERVAL = 100;
const WIDTH = 24;

/** A line that is drawn over and over, only where a person looks: on a terminal. */
export class ProgressBar {
  readonly #stream: Stderr;
  readonly #total: number | undefined;
  readonly #now: () => number;
  readonly #unit: string;
  readonly #title: string;
  readonly #started: number;
  #drawn = -Infinity;

  /** `total`: the number of pairs (or of `unit`), where it is known. `title`: what is done with them. */
  constructor(total: number | undefined, stream: Stderr, { unit = 'pairs', title = '', now = () => performance.now() } = {}) {
    this.#total = total;
    this.#unit = unit;
    this.#title = title;
    this.#stream = stream;
    this.#now = now;
    this.#started = now();
  }

  update(tally: Tally): void {
    const now = this.#now();
    if (!this.#stream.isTTY || now - this.#drawn < INTERVAL) return;
    this.#drawn = now;
    this.#stream.write(`\r\u001b[K${this.#title}${line(tally, this.#total, (now - this.#started) / 1000, this.#unit)}`);
  }

  /** Takes the line away, for what is to be read there. */
  clear(): void {
    if (this.#stream.isTTY && this.#drawn > -Infinity) this.#stream.write('\r\u001b[K');
  }
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
