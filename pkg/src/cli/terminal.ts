// What the program says: results on stdout, errors and progress on stderr.

import { writeSync } from 'node:fs';
import { VeroneseError, veroneseError } from '../common/errors.js';

export function print(text: string): Promise<void> {
  return new Promise((resolve, reject) => {
    const failed = (error: Error) => {
      reject(new VeroneseError('write-failed', `the result cannot be printed: ${error.message}`));
    };
    process.stdout.once('error', failed);
    process.stdout.write(text, (error) => {
      if (error) return failed(error);
      process.stdout.off('error', failed);
      resolve();
    });
  });
}

/** One line on stderr, whatever the error's message looks like. */
export function complain(thrown: unknown): void {
  const { code, message } = veroneseError(thrown);
  try {
    writeSync(2, `veronese: error: ${code}: ${message.replace(/\s+/g, ' ').trim()}\n`);
  } catch {
    // Nobody listens: the exit code says it.
  }
}

/** As {@link complain}, of what does not end the work. */
export function warn(sentence: string): void {
  process.stderr.write(`veronese: warning: ${sentence}\n`);
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
  readonly #stream: Pick<NodeJS.WriteStream, 'isTTY' | 'write'>;
  readonly #total: number | undefined;
  readonly #now: () => number;
  readonly #unit: string;
  readonly #title: string;
  readonly #started: number;
  #drawn = -Infinity;

  /** `total`: the number of pairs (or of what `unit` says), where it is known. `title`: what is done with them. */
  constructor(
    total: number | undefined,
    stream: Pick<NodeJS.WriteStream, 'isTTY' | 'write'> = process.stderr,
    now = () => performance.now(),
    unit = 'pairs',
    title = '',
  ) {
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
