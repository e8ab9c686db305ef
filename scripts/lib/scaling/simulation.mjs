// A simulation of clips in one tab or process, and on a farm. Nothing is random but when workers are killed, by a generator with a fixed seed.

import { random } from '../random.mjs';

/** Calls what is due in the order of its time: a binary heap. */
function simulation() {
  const heap = [];
  let order = 0;
  const earlier = (one, other) => one.time < other.time || (one.time === other.time && one.order < other.order);
  const clock = {
    now: 0,
    at(time, due) {
      const event = { time, due, order: order++ };
      let k = heap.push(event) - 1;
      for (let up; k > 0 && earlier(event, heap[(up = (k - 1) >> 1)]); k = up) heap[k] = heap[up];
      heap[k] = event;
    },
    run() {
      while (heap.length > 0) {
        const [first] = heap;
        const last = heap.pop();
        for (let k = 0; heap.length > 0; ) {
          let child = 2 * k + 1;
          if (child + 1 < heap.length && earlier(heap[child + 1], heap[child])) child += 1;
          if (child >= heap.length || earlier(last, heap[child])) {
            heap[k] = last;
            break;
          }
          heap[k] = heap[child];
          k = child;
        }
        clock.now = first.time;
        first.due();
      }
    },
  };
  return clock;
}

/** What is assumed and not measured. */
export const ASSUMED = {
  /** A killed worker loses its lock after 30 s, which is looked at every 30 s; another process takes its place. Seconds. */
  lock: 45,
  restart: 60,
  /** Of the shared file system, bytes per second: 10 Gbit/s. */
  bandwidth: 1.25e9,
};

/** Frames that a pool reads ahead for so many workers: see pkg/src/calls/clip/shared-pairs.ts. */
export const readAhead = (workers) => workers + 2;

/** One clip in a pool: pairs on all workers, objects in order on the first, which does that before anything else, then labels one by one. */
export function pool({ cost, frames, workers, start = 0 }) {
  const clock = simulation();
  const [room, known, idle] = [readAhead(workers), new Set([0]), Array.from({ length: workers }, (_, k) => k)];
  let [read, next, taken, reading] = [0, 1, 0, false];
  const give = () => {
    if (!reading && read < frames && read - taken < room) {
      reading = true;
      clock.at(clock.now + cost.decode, () => {
        [reading, read] = [false, read + 1];
        give();
      });
    }
    for (const worker of idle.splice(0)) {
      const after = (seconds, done) => clock.at(clock.now + seconds, () => {
        done();
        idle.push(worker);
        give();
      });
      if (worker === 0 && taken < read && known.has(taken)) after(cost.track, () => (taken += 1));
      else if (next < read) {
        const pair = next++;
        after(cost.pair, () => known.add(pair));
      } else idle.push(worker);
    }
  };
  clock.at(start, give);
  clock.run();
  const busy = workers * start + (frames - 1) * cost.pair + frames * (cost.track + cost.label + 2 * cost.decode);
  return { seconds: clock.now + frames * Math.max(cost.label, cost.decode), busy };
}

/** Seconds of a job: a block of pairs, or what ends a clip, with its pairs if it has no blocks. */
export function secondsOf({ pairs, ends }, { pair, track, label, decode, encode }, frames) {
  // The next frame is decoded beside the work. A block follows objects in vain, of one frame more than it has pairs; this is the most.
  if (!ends) return pairs * Math.max(pair + track, decode) + track;
  return pairs * Math.max(pair, decode) + frames * (Math.max(track, decode) + Math.max(label, decode) + encode);
}

/** Clips on workers that take jobs from a queue; each job waits for the queue and for the files that it reads and writes. */
export function farm({ cost, rate, clips, frames, workers, block, start = 0, kills = 0 }) {
  const { lock, restart, bandwidth } = ASSUMED;
  const clock = simulation();
  const pairs = frames - 1;
  const blocks = pairs > block ? Math.ceil(pairs / block) : 0;
  const [left, urgent, again, idle] = [new Uint16Array(clips).fill(blocks), [], [], []];
  let [fresh, queue, store, lost, busy, ended] = [0, 0, 0, 0, 0, 0];
  const next = random(1);
  const lifetime = () => (kills > 0 ? (-Math.log(1 - next()) * 3600) / kills : Infinity);
  const dies = Array.from({ length: workers }, lifetime);
  const perPair = Math.max(blocks === 0 ? cost.pair : cost.pair + cost.track, cost.decode);

  /** Jobs are taken in order; a clip whose blocks have ended comes first. */
  const job = () => {
    const found = urgent.pop() ?? again.shift();
    if (found || fresh === clips * Math.max(1, blocks)) return found;
    const number = fresh++;
    if (blocks === 0) return { clip: number, pairs, ends: true };
    const first = (number % blocks) * block;
    return { clip: Math.floor(number / blocks), pairs: Math.min(block, pairs - first), ends: false };
  };
  const give = () => {
    for (let task; idle.length > 0 && (task = job()); ) begin(idle.pop(), task);
  };
  const begin = (worker, task) => {
    queue = Math.max(queue, clock.now) + 1 / rate;
    // What a machine reads again it has in memory.
    const bytes = (task.ends ? frames : task.pairs + 1) * cost.file + task.pairs * cost.pairs + (task.ends ? frames * ((blocks && cost.pairs) + cost.png) : 0);
    store = Math.max(store, queue) + bytes / bandwidth;
    const seconds = secondsOf(task, cost, frames);
    if (dies[worker] < clock.now) dies[worker] = clock.now + lifetime();
    if (store + seconds > dies[worker]) {
      // What its last pair told is lost; those before are there.
      const solved = Math.min(task.pairs, Math.max(0, Math.floor((dies[worker] - store) / perPair)));
      lost += 1;
      busy += Math.max(0, dies[worker] - store);
      clock.at(dies[worker] + lock, () => {
        again.push({ ...task, pairs: task.pairs - solved });
        give();
      });
      clock.at(dies[worker] + restart, () => {
        dies[worker] = clock.now + lifetime();
        idle.push(worker);
        give();
      });
      return;
    }
    busy += seconds;
    clock.at(store + seconds, () => {
      if (task.ends) ended += 1;
      else if (--left[task.clip] === 0) urgent.push({ clip: task.clip, pairs: 0, ends: true });
      idle.push(worker);
      give();
    });
  };
  for (let worker = 0; worker < workers; worker++) {
    clock.at(start, () => {
      idle.push(worker);
      give();
    });
  }
  clock.run();
  if (ended !== clips) throw new Error(`${ended} of ${clips} clips`);
  return { seconds: clock.now, busy: busy + workers * start, lost };
}
