// Input and output of a run of the program, and the signal that stops it.

export interface Io {
  stdin: NodeJS.ReadableStream;
  stdout: NodeJS.WritableStream;
  stderr: Stderr;
  /** Aborted when a signal has come, just before the process ends: what is half-written goes in its listeners, at once. */
  signal: AbortSignal;
}

/** Text is out when `write` returns, and lost where nobody listens. */
export interface Stderr {
  isTTY: boolean;
  write: (text: string) => void;
}
