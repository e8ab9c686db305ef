// Seconds of processor that a program and all that it starts take. Linux tells them; elsewhere they are unknown.

import { readFileSync, readdirSync } from 'node:fs';

/** Of a process that ends between two looks, its parent tells what it took, once it has waited for it. */
const EVERY_MILLISECONDS = 500;
/** Linux counts in hundredths of a second for programs, whatever its own clock is. */
const TICKS_PER_SECOND = 100;

/** Whether this system tells what programs take. */
export const isKnown = process.platform === 'linux';

/** Every process that is an offspring of one of `watched`, and these, by number: the last that was seen of it. */
const seen = new Map();
const watched = new Set();
let timer;

/** Watches a process and its offspring until the function that this returns is called, which gives their seconds so far. */
export function watchProcessor(pid) {
  watched.add(pid);
  look();
  timer ??= setInterval(look, EVERY_MILLISECONDS).unref();
  return () => {
    look();
    watched.delete(pid);
    const seconds = secondsOf(pid);
    forget(pid);
    if (watched.size === 0) timer = clearInterval(timer);
    return seconds;
  };
}

function look() {
  const processes = new Map(allProcesses().map((one) => [one.pid, one]));
  for (const one of processes.values()) {
    // A process whose parent has ended stays where it was begun.
    const before = seen.get(one.pid);
    if (before) Object.assign(before, one, { parent: before.parent });
    else if (isOffspring(one, processes)) seen.set(one.pid, one);
  }
}

function isOffspring(one, processes) {
  for (let now = one; now; now = processes.get(now.parent)) if (watched.has(now.pid) || seen.has(now.pid)) return true;
  return false;
}

/** All processes: `{ pid, parent, own, waited }`, with the seconds of themselves and of those children that have ended and that they waited for. */
function allProcesses() {
  return readdirSync('/proc')
    .filter((name) => /^\d+$/.test(name))
    .flatMap((name) => {
      try {
        const line = readFileSync(`/proc/${name}/stat`, 'latin1');
        // The name of the program stands in brackets and may have spaces and brackets itself.
        const [, parent, , , , , , , , , , ...ticks] = line
          .slice(line.lastIndexOf(')') + 2)
          .split(' ')
          .map(Number);
        const [user, system, waitedUser, waitedSystem] = ticks;
        return [
          { pid: Number(name), parent, own: (user + system) / TICKS_PER_SECOND, waited: (waitedUser + waitedSystem) / TICKS_PER_SECOND },
        ];
      } catch {
        return []; // It has just ended.
      }
    });
}

/**
 * A process counts what its ended children took if it waited for them. Children that nobody waited for, as those of a browser that ends, count
 * with what was last seen of them.
 */
function secondsOf(pid) {
  const { own, waited } = seen.get(pid) ?? { own: 0, waited: 0 };
  const children = [...seen.values()].filter(({ parent }) => parent === pid).map((child) => secondsOf(child.pid));
  return (
    own +
    Math.max(
      waited,
      children.reduce((sum, seconds) => sum + seconds, 0),
    )
  );
}

function forget(pid) {
  for (const one of seen.values()) if (one.parent === pid) forget(one.pid);
  seen.delete(pid);
}
