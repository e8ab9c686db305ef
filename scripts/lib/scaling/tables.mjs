// The tables of docs/scaling.md.

import { farm, pool, readAhead } from './simulation.mjs';

const SIZE = '854 × 480';
/** Frames of a clip. */
const FRAMES = 60;
/** As long as the clip: it is one job. */
const WHOLE = FRAMES;
/** One worker in a hundred is killed in an hour, as of machines that are cheaper because they may be taken away. */
const KILLS = 0.01;

const FARMS = [
  { quality: 'best', clips: 1, workers: 1, block: WHOLE },
  { quality: 'best', clips: 1, workers: 4, block: 16 },
  { quality: 'best', clips: 1, workers: 8, block: 16 },
  { quality: 'best', clips: 1, workers: 8, block: 8 },
  { quality: 'best', clips: 1000, workers: 64, block: WHOLE },
  { quality: 'best', clips: 1000, workers: 64, block: 16 },
  { quality: 'best', clips: 1000, workers: 64, block: 16, kills: 1 },
  { quality: 'best', clips: 1e6, workers: 1024, block: WHOLE, kills: KILLS },
  { quality: 'best', clips: 1e6, workers: 1024, block: 16, kills: KILLS },
  { quality: 'best', clips: 1e6, workers: 16384, block: WHOLE, kills: KILLS },
  { quality: 'fast', clips: 1e6, workers: 1024, block: WHOLE, kills: KILLS },
  { quality: 'fast', clips: 1e6, workers: 1024, block: 16, kills: KILLS },
  { quality: 'fast', clips: 1e6, workers: 4096, block: WHOLE, kills: KILLS },
];

export function constantTable({ machine, frames, queue }) {
  const ms = (seconds) => (1000 * seconds).toFixed(seconds < 0.01 ? 1 : 0);
  const kb = (bytes) => (bytes / 1000).toFixed(1);
  const rows = Object.entries(frames).flatMap(([size, byQuality]) =>
    Object.entries(byQuality).map(([quality, { pair, track, label, decode, encode, file, pairs, state, png, memory }]) => [
      size, quality, ...[pair, track, label, decode, encode].map(ms), ...[file, pairs, state, png].map(kb), (memory / 2 ** 20).toFixed(0),
    ]));
  const head = ['frames', 'quality', 'pair', 'objects', 'labels', 'JPEG', 'PNG', 'JPEG, kB', 'pair, kB', 'state, kB', 'PNG, kB', 'memory, MiB'];
  const sentence = `One producer adds ${round(queue.produced)} jobs a second and one process takes ${round(queue.taken)}, when jobs do nothing; a job that waits takes ${round(queue.bytes)} bytes of the server’s memory, and ${round(queue.written)} bytes of its log.`;
  return [`${machine}.`, table([head, ...rows]), sentence].join('\n\n');
}

/** The simulation beside the runs that were measured: seconds, and in brackets those of the processor. */
export function checkTable({ frames, queue, run, runs, start, waits }) {
  const both = ({ seconds, busy }) => `${seconds.toFixed(1)} (${busy.toFixed(1)})`;
  const rows = runs.map(({ quality, workers, farm: onFarm, pool: inPool }) => {
    const cost = frames[run.size.join(' × ')][quality];
    const task = { cost, frames: run.frames, workers };
    const simulated = { pool: pool({ ...task, start: cost.cold }), farm: farm({ ...task, rate: queue.taken, clips: 1, block: run.block, start: start.busy + cost.cold }) };
    return [quality, workers, both(inPool), both(simulated.pool), both(onFarm), both(simulated.farm)];
  });
  const head = ['quality', 'workers', 'pool', 'simulated', 'farm', 'simulated'];
  return `${run.frames} frames of ${run.size.join(' × ')} pixels, in blocks of ${run.block} on the farm:\n\n${table([head, ...rows])}\n\nJobs that only wait, as long as *fast* takes:\n\n${waitTable({ frames, queue, waits })}`;
}

/** The simulation beside jobs that only wait: what the queue does, whoever uses the processor. */
function waitTable({ frames, queue, waits }) {
  const rows = waits.map(({ clips, workers, block, seconds }) => {
    const simulated = farm({ cost: frames[SIZE].fast, rate: queue.taken, frames: FRAMES, clips, workers, block }).seconds;
    return [clips, workers, block, seconds.toFixed(1), simulated.toFixed(1)];
  });
  return table([['clips', 'workers', 'block', 'seconds', 'simulated'], ...rows]);
}

export function poolTable({ frames }) {
  const rows = Object.entries(frames[SIZE]).flatMap(([quality, cost]) => {
    const alone = pool({ cost, frames: FRAMES, workers: 1 }).seconds;
    return [1, 2, 4, 8, 16].map((workers) => {
      const { seconds } = pool({ cost, frames: FRAMES, workers });
      return [quality, workers, seconds.toFixed(1), (FRAMES / seconds).toFixed(1), (alone / seconds).toFixed(2), readAhead(workers), ((readAhead(workers) * 4 * 854 * 480) / 2 ** 20).toFixed(0)];
    });
  });
  return table([['quality', 'workers', 'seconds', 'frames a second', 'times as fast', 'frames buffered', 'MiB'], ...rows]);
}

export function farmTable({ frames, queue }) {
  const rows = FARMS.map((task) => {
    const cost = frames[SIZE][task.quality];
    const one = farm({ cost, rate: queue.taken, clips: 1, frames: FRAMES, workers: 1, block: WHOLE }).seconds;
    const { seconds, lost } = farm({ cost, rate: queue.taken, frames: FRAMES, ...task });
    const { quality, clips, workers, block, kills = 0 } = task;
    const share = (100 * clips * one) / (workers * seconds);
    return [quality, clips.toLocaleString('en'), workers.toLocaleString('en'), block === WHOLE ? 'whole' : block, kills, lost.toLocaleString('en'), duration(seconds), round((clips * FRAMES) / seconds), share.toFixed(0)];
  });
  return table([['quality', 'clips', 'workers', 'block', 'kills per worker and hour', 'jobs killed', 'time', 'frames a second', '% of the ideal'], ...rows]);
}

function duration(seconds) {
  if (seconds < 120) return `${seconds.toFixed(1)} s`;
  return seconds < 7200 ? `${(seconds / 60).toFixed(1)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

function round(value) {
  return Number(value.toPrecision(3)).toLocaleString('en');
}

function table([head, ...rows]) {
  return [head, head.map(() => '---'), ...rows].map((cells) => `| ${cells.join(' | ')} |`).join('\n');
}
