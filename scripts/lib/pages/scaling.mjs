// The tables of docs/scaling.md.

import { ASSUMED, farm, pool, readAhead } from '../scaling/simulation.mjs';
import { amount, fixed, origin, ratio, table, whole } from './table.mjs';

const SIZE = '854 × 480';
/** Frames of a clip. */
const FRAMES = 60;
/** As long as the clip: it is one job. */
const WHOLE = FRAMES;
/** One worker in a hundred is killed in an hour, as of machines that are cheaper because they may be taken away. */
const KILLS = 0.01;
/** Pairs of a block, and jobs that wait at most. */
const BLOCK = 16;
const AHEAD = 10_000;
/** Frames of video a second, an assumed price of a core-hour in dollars, and clips that are paid for. */
const RATE = 25;
const PRICE = 0.04;
const CLIPS = 1e6;

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

export const PARTS = {
  constants: ['scaling', constantTable],
  pool: ['scaling', poolTable],
  farm: ['scaling', farmTable],
  check: ['scaling', checkTable],
  limits: ['scaling', limitTable],
  price: ['scaling', priceTable],
};

function constantTable({ frames, queue, ...figures }) {
  const ms = (seconds) => amount(1000 * seconds);
  const kb = (bytes) => amount(bytes / 1000);
  const rows = Object.entries(frames).flatMap(([size, byQuality]) =>
    Object.entries(byQuality).map(([quality, { pair, track, label, decode, encode, file, pairs, state, png, memory }]) => [
      size, quality, ...[pair, track, label, decode, encode].map(ms), ...[file, pairs, state, png].map(kb), fixed(memory / 2 ** 20, 0),
    ]));
  const head = ['frames', 'quality', 'pair', 'objects', 'labels', 'JPEG', 'PNG', 'JPEG, kB', 'pair, kB', 'state, kB', 'PNG, kB', 'memory, MiB'];
  const sentence = `One producer adds ${round(queue.produced)} jobs a second and one process takes ${round(queue.taken)}, when jobs do nothing; a job that waits takes ${round(queue.bytes)} bytes of the server’s memory, and ${round(queue.written)} bytes of its log.`;
  return [origin(figures), table(head, rows), sentence].join('\n\n');
}

/** The simulation beside the runs that were measured: seconds, and in brackets those of the processor. */
function checkTable({ frames, queue, run, runs, start, waits }) {
  const both = ({ seconds, busy }) => `${seconds.toFixed(1)} (${busy.toFixed(1)})`;
  const rows = runs.map(({ quality, workers, farm: onFarm, pool: inPool }) => {
    const cost = frames[run.size.join(' × ')][quality];
    const task = { cost, frames: run.frames, workers };
    const simulated = { pool: pool({ ...task, start: cost.cold }), farm: farm({ ...task, rate: queue.taken, clips: 1, block: run.block, start: start.busy + cost.cold }) };
    return [quality, workers, both(inPool), both(simulated.pool), both(onFarm), both(simulated.farm)];
  });
  const head = ['quality', 'workers', 'pool', 'simulated', 'farm', 'simulated'];
  return `${run.frames} frames of ${run.size.join(' × ')} pixels, in blocks of ${run.block} on the farm:\n\n${table(head, rows)}\n\nJobs that only wait, as long as *fast* takes:\n\n${waitTable({ frames, queue, waits })}`;
}

/** The simulation beside jobs that only wait: what the queue does, whoever uses the processor. */
function waitTable({ frames, queue, waits }) {
  const rows = waits.map(({ clips, workers, block, seconds }) => {
    const simulated = farm({ cost: frames[SIZE].fast, rate: queue.taken, frames: FRAMES, clips, workers, block }).seconds;
    return [clips, workers, block, seconds.toFixed(1), simulated.toFixed(1)];
  });
  return table(['clips', 'workers', 'block', 'seconds', 'simulated'], rows);
}

function poolTable({ frames }) {
  const rows = Object.entries(frames[SIZE]).flatMap(([quality, cost]) => {
    const alone = pool({ cost, frames: FRAMES, workers: 1 }).seconds;
    return [1, 2, 4, 8, 16].map((workers) => {
      const { seconds } = pool({ cost, frames: FRAMES, workers });
      return [quality, workers, seconds.toFixed(1), (FRAMES / seconds).toFixed(1), ratio(alone / seconds), readAhead(workers), ((readAhead(workers) * 4 * 854 * 480) / 2 ** 20).toFixed(0)];
    });
  });
  return table(['quality', 'workers', 'seconds', 'frames a second', 'times as fast', 'frames buffered', 'MiB'], rows);
}

function farmTable({ frames, queue }) {
  const rows = FARMS.map((task) => {
    const cost = frames[SIZE][task.quality];
    const one = farm({ cost, rate: queue.taken, clips: 1, frames: FRAMES, workers: 1, block: WHOLE }).seconds;
    const { seconds, lost } = farm({ cost, rate: queue.taken, frames: FRAMES, ...task });
    const { quality, clips, workers, block, kills = 0 } = task;
    const share = (100 * clips * one) / (workers * seconds);
    return [quality, clips.toLocaleString('en'), workers.toLocaleString('en'), block === WHOLE ? 'whole' : block, kills, lost.toLocaleString('en'), duration(seconds), round((clips * FRAMES) / seconds), share.toFixed(0)];
  });
  return table(['quality', 'clips', 'workers', 'block', 'kills per worker and hour', 'jobs killed', 'time', 'frames a second', '% of the ideal'], rows);
}

/** How far the network, the queue and the memory of a machine go. */
function limitTable({ frames, queue }) {
  const costs = Object.entries(frames[SIZE]);
  const { bandwidth } = ASSUMED;
  // Blocks read a frame twice; pairs are written and read again.
  const bytes = { blocks: ({ file, pairs, png }) => 2 * file + 2 * pairs + png, clips: ({ file, png }) => file + png };
  const row = (title, of) => [title, ...costs.map(([, cost]) => round(of(cost)))];
  const rows = [
    row('network, kB a frame, blocks', (cost) => bytes.blocks(cost) / 1000),
    row('the same, whole clips', (cost) => bytes.clips(cost) / 1000),
    row('frames a second at 10 Gbit/s, blocks', (cost) => bandwidth / bytes.blocks(cost)),
    row('the same, whole clips', (cost) => bandwidth / bytes.clips(cost)),
    row('workers that one queue feeds, blocks', ({ pair, track }) => queue.taken * BLOCK * (pair + track)),
    row(`memory of the queue, ${whole(AHEAD)} jobs, MB`, () => (AHEAD * queue.bytes) / 1e6),
    row('memory of 64 workers, GB', ({ memory }) => (64 * memory) / 1e9),
  ];
  return table(['', ...costs.map(([quality]) => quality)], rows);
}

/** Core-hours and dollars of video, and of many clips. */
function priceTable({ frames }) {
  const rows = Object.entries(frames[SIZE]).map(([quality, { pair, track, label, decode, encode }]) => {
    const perFrame = pair + track + label + 2 * decode + encode;
    const [video, clips] = [3600 * RATE, CLIPS * FRAMES].map((count) => (count * perFrame) / 3600);
    return [quality, amount(video), `$${(PRICE * video).toFixed(2)}`, round(clips), `$${round(PRICE * clips)}`];
  });
  return table(['quality', 'core-hours for an hour of video', 'price', `for ${whole(CLIPS)} clips of ${FRAMES} frames`, 'price'], rows);
}

function duration(seconds) {
  if (seconds < 120) return `${seconds.toFixed(1)} s`;
  return seconds < 7200 ? `${(seconds / 60).toFixed(1)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

function round(value) {
  return Number(value.toPrecision(3)).toLocaleString('en');
}
