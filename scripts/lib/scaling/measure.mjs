// What `npm run scaling -- --measure` measures: what a frame costs in a worker, what the queue manages, and two runs to compare the simulation
// with. Times of frames are processor time, because other programs may use the machine.

import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';

import { SCALE_OUT } from '../npm-packages.mjs';
import { root } from '../project.mjs';
import { Stop, must } from '../run.mjs';
import { redisServer, withServer } from '../scale-out.mjs';
import { secondsOf } from './simulation.mjs';

const SIZES = [[320, 240], [640, 480], [854, 480], [1920, 1080]];
const QUALITIES = ['fast', 'best'];
/** Pairs that are solved, of large frames fewer: no measurement is to take minutes. */
const pairsOf = ([width]) => (width > 1000 ? 8 : 12);
const ATTEMPTS = { fast: 3, best: 2 };
/** What is segmented as a whole: the frames whose costs are measured, since others may cost twice as much. */
const RUN = { size: [854, 480], frames: 13, block: 3 };

export async function measured(clip, say) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-scaling-'));
  try {
    const frames = {};
    for (const size of SIZES) {
      const place = await scaled(clip, join(folder, size.join('x')), size, pairsOf(size) + 1);
      for (const quality of QUALITIES) {
        const program = [fileURLToPath(new URL('measure-frames.mjs', import.meta.url)), place, quality];
        const { stdout } = await must('The frames could not be measured.', process.execPath, program, { output: 'collect' });
        (frames[size.join(' × ')] ??= {})[quality] = JSON.parse(stdout);
        say(`${size.join(' × ')}, ${quality}: ${stdout}`);
      }
    }
    const program = await redisServer();
    if (!program) throw new Stop('There is no redis-server and no valkey-server.');
    const queue = await queueMeasured(program);
    say(JSON.stringify(queue));
    const short = await scaled(clip, join(folder, 'short'), [64, 48], 2);
    const start = await farmMeasured(program, short, 'fast', 1);
    say(`start: ${JSON.stringify(start)}`);
    const runs = await runsMeasured(program, await scaled(clip, join(folder, 'run'), RUN.size, RUN.frames), say);
    const waits = await waitsMeasured(program, frames['854 × 480'].fast, say);
    return { frames, queue, start, run: RUN, runs, waits };
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** The first frames of a clip as JPEG files of another size. */
async function scaled(clip, place, [width, height], count) {
  mkdirSync(place);
  const from = ['-pattern_type', 'glob', '-i', join(clip, `*.${readdirSync(clip)[0].split('.').at(-1)}`)];
  const to = ['-vf', `scale=${width}:${height}`, '-frames:v', String(count), '-q:v', '2', join(place, '%04d.jpg')];
  await must('The frames could not be scaled.', 'ffmpeg', ['-v', 'error', ...from, ...to], { output: 'collect' });
  if (readdirSync(place).length < count) throw new Stop(`${clip} has fewer than ${count} frames.`);
  return place;
}

/** BullMQ as the example has it, and connections that end together. */
function clients(url) {
  const require = createRequire(join(root, SCALE_OUT, 'package.json'));
  const { Redis } = require('ioredis');
  const connections = [];
  const connect = () => {
    const connection = new Redis(url, { maxRetriesPerRequest: null });
    connection.on('error', () => undefined); // The server may still be starting.
    connections.push(connection);
    return connection;
  };
  return { ...require('bullmq'), connect, end: () => Promise.all(connections.map((connection) => connection.quit())) };
}

/** Jobs that do nothing, in flows of five as a clip of 60 frames has. */
function queueMeasured(program) {
  return withServer(program, async ({ folder, redis, url }) => {
    redis();
    const { FlowProducer, Queue, Worker, connect, end } = clients(url);
    const connection = connect();
    const [flows, queue] = [new FlowProducer({ connection }), new Queue('empty', { connection })];
    const used = async () => Number(/used_memory:(\d+)/.exec(await connection.info('memory'))[1]);
    const [clips, blocks, name] = [2000, 4, 'x'.repeat(70)];
    await queue.waitUntilReady();
    const empty = await used();
    const data = (k) => ({ index: k, job: name, clip: name, folder: `/srv/clips/${k}`, from: 0, to: 16, out: '/srv/out', options: { quality: 'best' } });
    const job = (id, k) => ({ name: 'block', queueName: 'empty', data: data(k), opts: { jobId: `${name}${id}`, attempts: 5, backoff: { type: 'exponential', delay: 1000 }, removeOnComplete: true } });
    const adding = performance.now();
    for (let k = 0; k < clips; k++) await flows.add({ ...job(`c${k}`, k), children: Array.from({ length: blocks }, (_, b) => job(`b${k}-${b}`, k)) });
    const jobs = clips * (blocks + 1);
    const produced = (1000 * jobs) / (performance.now() - adding);
    const bytes = ((await used()) - empty) / jobs;
    const written = readdirSync(join(folder, 'appendonlydir')).reduce((sum, name) => sum + statSync(join(folder, 'appendonlydir', name)).size, 0) / jobs;
    const taking = performance.now();
    let done = 0;
    await new Promise((resolve) => {
      const worker = new Worker('empty', async () => undefined, { connection: connect(), concurrency: 64 });
      worker.on('completed', () => {
        if (++done === jobs) resolve(worker.close());
      });
    });
    const taken = (1000 * jobs) / (performance.now() - taking);
    await flows.close();
    await queue.close();
    await end();
    return Object.fromEntries(Object.entries({ produced, taken, bytes, written }).map(([name, value]) => [name, round(value)]));
  }, { appendfsync: 'everysec' });
}

/**
 * Seconds that a clip takes, and processor seconds: in blocks, by so many processes of the example with a job each, and in a pool. Of some
 * runs, the one that got most of the processor: others may use it.
 */
export async function runsMeasured(program, place, say) {
  const runs = [];
  for (const quality of QUALITIES) {
    for (const workers of [1, 2]) {
      const best = async (measure) => {
        const found = [];
        for (let attempt = 0; attempt < ATTEMPTS[quality]; attempt++) found.push(await measure(program, place, quality, workers));
        return found.reduce((one, other) => (one.busy / one.seconds > other.busy / other.seconds ? one : other));
      };
      runs.push({ quality, workers, farm: await best(farmMeasured), pool: await best(poolMeasured) });
      say(JSON.stringify(runs.at(-1)));
    }
  }
  return runs;
}

async function poolMeasured(_, place, quality, workers) {
  const task = [fileURLToPath(new URL('measure-pool.mjs', import.meta.url)), place, quality, String(workers)];
  const { stdout } = await must('The pool could not be measured.', process.execPath, task, { output: 'collect' });
  return JSON.parse(stdout);
}

function farmMeasured(program, place, quality, workers) {
  return withServer(program, async ({ folder, redis, node, finished, worker }) => {
    redis();
    await finished(node('produce-clips.mjs', place, '--out', join(folder, 'out'), '--quality', quality, '--block', String(RUN.block)));
    const since = performance.now();
    const started = Array.from({ length: workers }, () => worker());
    // The clip's own job says what it has solved.
    const isDone = () => started.some(({ text }) => text.includes('"solved"'));
    await new Promise((resolve) => {
      for (const { child } of started) child.stdout.on('data', () => isDone() && resolve());
    });
    const seconds = (performance.now() - since) / 1000;
    const failed = started.find(({ errors }) => errors !== '');
    if (failed) throw new Stop(failed.errors);
    return { seconds: round(seconds), busy: round(started.reduce((sum, { child }) => sum + processorSeconds(child.pid), 0)) };
  });
}

const WAITS = [
  { clips: 1, workers: 1, block: 16 },
  { clips: 1, workers: 2, block: 16 },
  { clips: 1, workers: 8, block: 8 },
  { clips: 20, workers: 8, block: 16 },
  { clips: 200, workers: 100, block: 16 },
];

/** Seconds of clips of 60 frames whose jobs wait as long as they would work: what the queue does, whoever uses the processor. */
export async function waitsMeasured(program, cost, say) {
  const [frames, found] = [60, []];
  for (const { clips, workers, block } of WAITS) {
    const seconds = await withServer(program, async ({ redis, url }) => {
      redis();
      const { FlowProducer, Worker, connect, end } = clients(url);
      const flows = new FlowProducer({ connection: connect() });
      const job = (name, pairs) => ({ name, queueName: 'waits', data: { pairs, ends: name === 'clip' } });
      const sizes = Array.from({ length: Math.ceil((frames - 1) / block) }, (_, k) => Math.min(block, frames - 1 - k * block));
      for (let k = 0; k < clips; k++) await flows.add({ ...job('clip', 0), children: sizes.map((pairs) => job('block', pairs)) });
      const since = performance.now();
      const worker = new Worker('waits', ({ data }) => sleep(1000 * secondsOf(data, cost, frames)), { connection: connect(), concurrency: workers });
      let done = 0;
      await new Promise((resolve) => worker.on('completed', ({ name }) => name === 'clip' && ++done === clips && resolve()));
      const taken = (performance.now() - since) / 1000;
      await worker.close();
      await flows.close();
      await end();
      return round(taken);
    });
    found.push({ clips, workers, block, seconds });
    say(JSON.stringify(found.at(-1)));
  }
  return found;
}

/** On Linux, in hundredths of a second. */
function processorSeconds(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

function round(value) {
  return Number(value.toPrecision(3));
}
