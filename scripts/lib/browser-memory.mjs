// The memory of a browser (Linux only).

import { readFileSync } from 'node:fs';

/** The memory of all processes of the browser, what they share counted once, bytes. `session` is of the DevTools protocol. */
export async function browserMemory(session) {
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  return processInfo.reduce((sum, { id }) => sum + proportional(id), 0);
}

function proportional(id) {
  try {
    return 1024 * Number(/^Pss:\s+(\d+) kB/m.exec(readFileSync(`/proc/${id}/smaps_rollup`, 'utf8'))?.[1] ?? 0);
  } catch {
    return 0; // It has ended meanwhile.
  }
}
