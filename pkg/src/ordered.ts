// Many inputs through a few workers, answers in the order of the inputs, and no input taken before there is room for it.

export interface OrderOptions {
  /** How many inputs may be under way or answered and not fetched yet. */
  room: number;
  /** Ends the wait for the source or an answer; its reason is thrown as `stop` makes it. */
  signal?: AbortSignal | undefined;
  stop: () => unknown;
}

/**
 * Whoever is slow, the source, the work or the reader, holds up the others, so that nothing piles up. `work` must not reject.
 * Where the source throws, what was taken before is answered first; where the reader stops, so does the source.
 */
export async function* inOrder<Input, Answer>(
  source: Iterable<Input | Promise<Input>> | AsyncIterable<Input>,
  work: (input: Input, index: number) => Promise<Answer>,
  { room, signal, stop }: OrderOptions,
): AsyncGenerator<Answer, void, undefined> {
  const inputs = iteratorOf(source);
  const answers: Promise<Answer>[] = [];
  let index = 0;
  let ended = false;
  let failure: { thrown: unknown } | undefined;
  let taking: Promise<void> | undefined;

  /** Takes one input; work on it begins. */
  const take = async () => {
    try {
      const { done, value } = await inputs.next();
      if (done) ended = true;
      else answers.push(work((await value) as Input, index++));
    } catch (thrown) {
      ended = true;
      failure = { thrown };
    }
    taking = undefined;
  };

  const aborted = whenAborted(signal);
  try {
    for (;;) {
      if (signal?.aborted) throw stop();
      if (!ended && answers.length < room) taking ??= take();
      const first = answers[0];
      if (!first && !taking) break;
      // A slow source does not hold back an answer that is there.
      let answer: { value: Answer } | undefined;
      const answered = first?.then((value) => {
        answer = { value };
      });
      await Promise.race([taking, answered, aborted.promise].filter((promise) => promise !== undefined));
      if (!answer) continue;
      answers.shift();
      yield answer.value;
    }
    if (failure) throw failure.thrown;
  } finally {
    aborted.release();
    if (!ended) void Promise.resolve(inputs.return?.()).catch(() => undefined);
  }
}

function iteratorOf<T>(source: Iterable<T | Promise<T>> | AsyncIterable<T>): AsyncIterator<T> | Iterator<T | Promise<T>> {
  return Symbol.asyncIterator in source ? source[Symbol.asyncIterator]() : source[Symbol.iterator]();
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
