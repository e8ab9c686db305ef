// Many inputs through a few workers, answers in the order of the inputs, and no input taken before there is room for it.

import { VeroneseError } from '../common/errors.js';

export interface OrderOptions {
  /** How many inputs may be under way or answered and not fetched yet. */
  room: number;
  /** Ends the wait for the source or an answer; its reason is thrown as `stop` makes it. */
  signal?: AbortSignal | undefined;
  stop: () => unknown;
  /** Gets what asks the source for an input already, if there is room, while the reader is busy with the answer before. */
  begun?: (ask: () => void) => void;
}

/**
 * Whoever is slow, the source, the work or the reader, holds up the others, so that nothing piles up. `work` must not reject; it is
 * called as soon as the source has given an input, before the source is asked for the next one. Where the source throws, what was
 * taken before is answered first; where the reader stops, so does the source.
 */
export async function* inOrder<Input, Answer>(
  source: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
  work: (input: Input, index: number) => Promise<Answer>,
  { room, signal, stop, begun }: OrderOptions,
): AsyncGenerator<Answer, void, undefined> {
  const inputs = iteratorOf(source);
  const answers: Promise<Answer>[] = [];
  let index = 0;
  /** Whether the iterator may still be asked, and whether it still has to be told that nobody will. */
  let [ended, open] = [false, true];
  let failure: { thrown: unknown } | undefined;
  let taking: Promise<void> | undefined;

  /** Takes one input; work on it begins. */
  const take = async () => {
    let value: Input | Promise<Input>;
    try {
      const result = await inputs.next();
      if (!isObject(result)) throw malformed('next() must give an object');
      if (result.done) {
        ended = true;
        open = false;
        return;
      }
      value = result.value;
    } catch (thrown) {
      // An iterator that throws has closed itself.
      open = false;
      throw thrown;
    }
    const input = await value;
    // The reader may have left while the source was asked.
    if (!ended) answers.push(work(input, index++));
  };

  const fail = (thrown: unknown) => {
    ended = true;
    failure = { thrown };
  };

  const ask = () => {
    if (ended || taking || answers.length >= room) return;
    taking = take()
      .catch(fail)
      .finally(() => {
        // Never before the assignment, also where the source throws at once: a wait for what is over would spin.
        taking = undefined;
      });
  };

  const aborted = whenAborted(signal);
  try {
    begun?.(ask);
    for (;;) {
      if (signal?.aborted) throw stop();
      ask();
      const first = answers[0];
      if (!first && !taking) break;
      // A slow source does not hold back an answer that is there.
      let answer: { value: Answer } | undefined;
      const answered = first?.then((value) => {
        answer = { value };
      });
      await Promise.race([taking, answered, aborted.promise].filter((promise) => promise !== undefined));
      if (!answer) continue;
      void answers.shift();
      yield answer.value;
    }
    if (failure) throw failure.thrown;
  } finally {
    aborted.release();
    ended = true;
    if (open) void close(inputs);
  }
}

/** The protocol of `for await`, whose errors are ours to tell. */
function iteratorOf<T>(source: Iterable<T | Promise<T>> | AsyncIterable<T>): AsyncIterator<T> | Iterator<T | Promise<T>> {
  const { [Symbol.asyncIterator]: asynchronous, [Symbol.iterator]: synchronous } = source as AsyncIterable<T> & Iterable<T | Promise<T>>;
  const iterator = (asynchronous ?? synchronous).call(source) as AsyncIterator<T> | Iterator<T | Promise<T>>;
  if (isObject(iterator) && typeof iterator.next === 'function') return iterator;
  throw malformed('it must be an object with a method next()');
}

function malformed(reason: string): VeroneseError {
  return new VeroneseError('invalid-input', `the source has no proper iterator: ${reason}`);
}

function isObject(value: unknown): value is object {
  return (typeof value === 'object' && value !== null) || typeof value === 'function';
}

/** Nobody waits for it, since a source that is asked for an input may never answer; nor does anybody hear what it throws. */
async function close(inputs: AsyncIterator<unknown> | Iterator<unknown>): Promise<void> {
  try {
    await inputs.return?.();
  } catch {
    // The reader has left, or has an error of more weight.
  }
}

function whenAborted(signal: AbortSignal | undefined): { promise: Promise<void> | undefined; release: () => void } {
  if (!signal) return { promise: undefined, release: () => undefined };
  let release: () => void = () => undefined;
  const promise = new Promise<void>((resolve) => {
    const listener = () => resolve();
    signal.addEventListener('abort', listener);
    release = () => signal.removeEventListener('abort', listener);
  });
  return { promise, release };
}
