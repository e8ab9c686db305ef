// Input and output of a run of the program, and the signal that stops it.

export interface Io {
  stdin: NodeJS.ReadableStream;
  stdout: NodeJS.WritableStream & Colours;
  stderr: Stderr;
  /** Aborted when a signal has come, just before the process ends: what is half-written goes in its listeners, at once. */
  signal: AbortSignal;
}

/** As of Node's terminals, which look at NO_COLOR. */
interface Colours {
  hasColors?: () => boolean;
}

/** Text is out when `write` returns, and lost where nobody listens. */
export interface Stderr extends Colours {
  isTTY: boolean;
  /** Whether only errors are wanted there. */
  quiet?: boolean;
  write: (text: string) => void;
}
