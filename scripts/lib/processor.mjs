// Seconds of processor that programs take, with all that they start: browsers too, which nobody waits for. Linux tells, in /proc; elsewhere
// nothing is known.
//
// Twice a second every process is looked at. It belongs to the name of the program that started it. What a process took before it was last
// seen is its own; what ended unseen is in the account of the process that waited for it.

import { readFileSync, readdirSync } from 'node:fs';
import { cpus } from 'node:os';

/** Between two looks, milliseconds. */
const PAUSE = 500;
/** Linux counts in hundredths of a second wherever Node runs. */
const TICKS = 100;
const PROC = '/proc';
const IS_KNOWN = process.platform === 'linux';

/** By process: `{ own, waited, children }`, in ticks. A number of a process that ended may be used again: its start tells them apart. */
const seen = new Map();
/** By name, the processes that were started for it. */
const started = new Map();
let timer;

/** Counts a process that has just been started, and all that it starts, under a name. */
export function account(name, pid) {
  if (!IS_KNOWN) return;
  const status = read(pid);
  if (status) started.set(name, [...(started.get(name) ?? []), add(status)]);
  if (timer) return;
  timer = setInterval(look, PAUSE);
  timer.unref();
}

/** Seconds of all that was counted under a name so far; undefined where it is not known. */
export function secondsOf(name) {
  if (!IS_KNOWN) return undefined;
  look();
  return sum(started.get(name) ?? []) / TICKS;
}

/** What a parent has waited for is in its account, once it has; until then it is in those of its children. */
function sum(processes) {
  return processes.reduce((ticks, { own, waited, children }) => ticks + own + Math.max(waited, sum(children)), 0);
}

/** Seconds that the whole machine has worked since it was started, for whomever. */
export function secondsOfMachine() {
  return cpus().reduce((sum, { times }) => sum + times.user + times.nice + times.sys + times.irq, 0) / 1000;
}

function look() {
  const now = new Map();
  for (const entry of readdirSync(PROC)) {
    const status = /^\d+$/.test(entry) ? read(entry) : undefined;
    if (status) now.set(Number(entry), status);
  }
  for (const pid of now.keys()) place(pid, now);
}

/** The account of a process, made if it descends from one that has one. */
function place(pid, now) {
  const status = now.get(pid);
  if (!status) return undefined;
  const known = seen.get(status.key);
  if (known) return Object.assign(known, { own: status.own, waited: status.waited });
  const parent = place(status.parent, now);
  if (!parent) return undefined;
  const made = add(status);
  parent.children.push(made);
  return made;
}

function add({ key, own, waited }) {
  const made = { own, waited, children: [] };
  seen.set(key, made);
  return made;
}

/** See proc_pid_stat(5). The name of a program, in brackets, may have spaces. */
function read(pid) {
  try {
    const text = readFileSync(`${PROC}/${pid}/stat`, 'utf8');
    const fields = text.slice(text.lastIndexOf(')') + 2).split(' ');
    const [parent, user, system, waitedUser, waitedSystem, start] = [1, 11, 12, 13, 14, 19].map((k) => Number(fields[k]));
    return { key: `${pid}:${start}`, parent, own: user + system, waited: waitedUser + waitedSystem };
  } catch {
    return undefined; // It has just ended.
  }
}
