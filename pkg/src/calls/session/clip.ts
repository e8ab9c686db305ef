// A clip from its opening to its closing. The core's clip lives in a home: a worker, or this thread. Here are its frames and its journal, and the
// loop that gives it the frames that it wants. A home that dies is replaced by another one, which reads the journal.

import type {
  Clip,
  ClipAnnotation,
  ClipEntry,
  ClipEvent,
  ClipFrame,
  ClipFrameStatus,
  ClipJournal,
  ClipStep,
  ClipTracks,
  Pixels,
  Segmentation,
} from '../../../types/index.js';
import { checkedBytes, entriesOf, invalidInput, invalidOption, isWhole, optionsObject, reading, UNLABELLED } from '../../common/checks.js';
import { cancelled, VeroneseError } from '../../common/errors.js';
import { checkCount } from '../clip/frames.js';
import { type Seen, Tracks, seenIn, sized } from '../clip/tracks.js';
import type { ClipAnswer, ClipCommand, ClipStatus, ClipTask, LabelledFrame, SettledStep, WantedFrame } from '../messages.js';
import { taken } from '../taking.js';
import { type Perform, parted } from '../tasks.js';
import { Ahead, type Solve, type Solved } from './ahead.js';
import * as commands from './commands.js';
import type { ClipFrames } from './frames.js';
import type { JournalWriter } from './journal.js';
import { Step, type StepClip, type StepRange } from './step.js';

/** Checks an annotation before there is a clip. */
export { annotationOf } from './commands.js';

/** The worker in which a clip lives, or this thread. */
export interface Home {
  perform: Perform;
  /** Does a task without state in another worker, or in any. */
  beside?: Perform;
  anywhere?: Perform;
  /** Number of workers. */
  size: number;
  /** Ends other workers that have nothing to do. */
  endIdle?: () => void;
  release: () => void;
}

/** Finds a home; `onLost` is called when its worker has ended. */
export type House = (onLost?: (reason: VeroneseError) => void) => Home;

export interface ClipParts {
  frames: ClipFrames;
  journal: ClipJournal;
  writer: JournalWriter;
  markUnknown: boolean;
  house: House;
}

/** Somebody who waits for the labels of a frame. */
interface Request {
  index: number;
  /** Whether the frame has no masks yet, but a range is coming to it. */
  isParked: boolean;
  resolve: (frame: ClipFrame) => void;
  reject: (reason: unknown) => void;
}

const HAS_MASKS = 1;
const ACCEPTED = 2;
const ANNOTATED = 4;
/** Bytes of frames that are read ahead. */
const MOST_AHEAD = 256 << 20;
const NOTHING: ClipStatus = {
  flags: new Uint8Array(),
  revisions: new Float64Array(),
  objects: [],
  nextObject: 1,
  width: 0,
  height: 0,
  dropped: 0,
  solved: [],
};

/** Number of clips so far. Each number is used once, because a module that replaces another after a panic must not find a clip under it. */
let clips = 0;

export class OpenedClip implements Clip, StepClip {
  readonly #parts: ClipParts;
  #place: { home: Home; clip: number } | undefined;
  #status = NOTHING;
  #frames: readonly ClipFrameStatus[] | undefined;
  #steps = { undo: 0, redo: 0, waiting: 0 };
  #wanted: WantedFrame | undefined;
  /** Settled when all calls so far have been answered: they are made one after another. */
  #turn: Promise<unknown> = Promise.resolve();
  #isRunning = false;
  /** The steps that are not settled: all, and by number those that the core has. */
  readonly #given = new Set<Step>();
  readonly #pending = new Map<number, Step>();
  #requests: Request[] = [];
  /** The frames of the range that is being segmented. */
  #ahead: { step: Step; frames: Ahead; ending: AbortController } | undefined;
  /** The frame that is being read for anything else. */
  #reading: { index: number; frame: Promise<Pixels> } | undefined;
  /** Size of the frame that was read last. */
  #size = { width: 0, height: 0 };
  /** Whether a frame that an annotation needs could not be read: the next command tries again. */
  #isPaused = false;
  /** Tells the loop that something has come. */
  #wake = () => {};
  /** What tracks need of the labels of each frame. */
  readonly #seen = new Map<number, Seen>();
  /** Whether one motion was asked for: then nobody asks why there is no object. */
  #isOneMotion = false;
  readonly #listeners = new Set<(event: ClipEvent) => void>();
  /** Why the last home was lost. */
  #lost: VeroneseError | undefined;
  /** Why nothing more is taken, and why the clip is closed. */
  #closing: VeroneseError | undefined;
  #closed: VeroneseError | undefined;
  #journalClosed: Promise<void> = Promise.resolve();
  isDamaged = false;

  constructor(parts: ClipParts) {
    this.#parts = parts;
  }

  /** Makes the clip in a home, from what was saved if there is something. */
  async open(saved: Uint8Array | undefined): Promise<ClipAnswer> {
    const { house, frames, markUnknown } = this.#parts;
    // The pool outlives a clip that nobody has any more.
    const own = new WeakRef(this);
    const place = { home: house((reason) => own.deref()?.homeLost(reason)), clip: clips++ };
    this.#place = place;
    const { journal, writer } = this.#parts;
    homes.register(this, { ...place, journal, writer }, this);
    const task: ClipTask = {
      call: 'openClip',
      clip: place.clip,
      frames: frames.length,
      markUnknown,
      saved: saved && new Uint8Array(saved),
    };
    const answer = (await place.home.perform(task, {}).catch((thrown) => {
      this.#leave();
      throw thrown;
    })) as ClipAnswer;
    if (answer.length === frames.length) return answer;
    this.#leave();
    throw new VeroneseError('invalid-option', `option 'saved': it is of a clip of ${answer.length} frames, not ${frames.length}`);
  }

  /** Begins with what {@link open} has answered, and goes on with annotations that are still to be applied. */
  begin(answer: ClipAnswer): void {
    void this.#answered(answer);
    void this.#run();
  }

  get length(): number {
    return this.#parts.frames.length;
  }

  get width(): number {
    return this.#status.width;
  }

  get height(): number {
    return this.#status.height;
  }

  get objects(): readonly ClipEntry[] {
    return this.#status.objects;
  }

  get frames(): readonly ClipFrameStatus[] {
    const { flags, revisions } = this.#status;
    return (this.#frames ??= Array.from(flags, (flag, index) => ({
      hasMasks: (flag & HAS_MASKS) !== 0,
      accepted: (flag & ACCEPTED) !== 0,
      annotated: (flag & ANNOTATED) !== 0,
      revision: revisions[index] as number,
    })));
  }

  get steps(): Clip['steps'] {
    const { undo, redo, waiting } = this.#steps;
    return { undo, redo, waiting: waiting + this.#unanswered().length };
  }

  /** The steps that the core does not have yet. */
  #unanswered(): Step[] {
    return [...this.#given].filter(({ number }) => number === 0);
  }

  get nextObject(): number {
    const { nextObject, objects } = this.#status;
    const coming = new Set(this.#unanswered().flatMap((step) => step.objects));
    if (coming.size === 0) return nextObject;
    const isFree = (number: number) => number >= nextObject && !coming.has(number) && !objects.some((object) => object.number === number);
    const free = nextObject === 0 ? [] : Array.from({ length: UNLABELLED - 1 }, (_, k) => k + 1).filter(isFree);
    return free[0] ?? 0;
  }

  segment(options?: Parameters<Clip['segment']>[0]): ClipStep {
    const { length } = this;
    const read = () => {
      const given = { ...optionsObject(options) };
      const { first = 0, last = length - 1, drafts = false, pairs, ...rest } = given;
      const { call, settings } = parted(rest, ['motions', 'quality', 'subject']);
      checkCount(length);
      if (!isWhole(last, 1, length - 1))
        throw new VeroneseError('invalid-option', `option 'last': must be a frame from 1 to ${length - 1}`);
      if (!isWhole(first, 0, last - 1))
        throw new VeroneseError('invalid-option', `option 'first': must be a frame before the last, ${last}`);
      if (typeof drafts !== 'boolean') throw invalidOption('drafts', 'true or false', drafts);
      if (pairs !== undefined && typeof pairs !== 'function') throw invalidOption('pairs', 'a function', pairs);
      if (call.signal?.aborted) throw cancelled(call.signal);
      return { range: { first, last, options: settings, drafts, pairs: pairs as StepRange['pairs'] }, signal: call.signal };
    };
    let asked: ReturnType<typeof read>;
    try {
      asked = reading(read);
    } catch (thrown) {
      return this.#failed(thrown);
    }
    const { range, signal } = asked;
    const { first, last, options: settings } = range;
    this.#isOneMotion = settings['motions'] === 1;
    const step = this.#apply(() => ({ type: 'segment', first, last, options: settings }), range);
    if (signal) {
      const cancel = () => {
        step.reason = cancelled(signal);
        step.cancel();
      };
      signal.addEventListener('abort', cancel);
      const release = () => signal.removeEventListener('abort', cancel);
      void step.then(release, release);
    }
    return step;
  }

  annotate(...annotations: Parameters<Clip['annotate']>): ClipStep {
    return this.#apply(() => commands.annotateCommand(this, annotations));
  }

  clear(annotations: Parameters<Clip['clear']>[0]): ClipStep {
    return this.#apply(() => commands.clearCommand(this, annotations));
  }

  accept(frames: Parameters<Clip['accept']>[0], on = true): ClipStep {
    const all = () => this.frames.flatMap(({ hasMasks }, index) => (hasMasks ? [index] : []));
    return this.#apply(() => commands.acceptCommand(this, frames === 'all' ? all() : frames, on));
  }

  lock(objects: readonly number[], on = true): ClipStep {
    return this.#apply(() => commands.lockCommand(objects, on));
  }

  describe(object: number, description: Parameters<Clip['describe']>[1], options?: Parameters<Clip['describe']>[2]): ClipStep {
    return this.#apply(() => commands.describeCommand(object, description, entriesOf(options, ['coalesce'])['coalesce'] ?? false));
  }

  merge(...objects: number[]): ClipStep {
    return this.#apply(() => commands.objectsCommand('merge', objects));
  }

  delete(...objects: number[]): ClipStep {
    return this.#apply(() => commands.objectsCommand('delete', objects));
  }

  split(object: number, frame: number): ClipStep {
    return this.#apply(() => commands.splitCommand(this, object, frame, this.nextObject));
  }

  replaceAnnotations(declaration: Parameters<Clip['replaceAnnotations']>[0]): ClipStep {
    return this.#apply(() => commands.replaceCommand(this, declaration));
  }

  restore(saved: Uint8Array): ClipStep {
    return this.#apply(() => ({ type: 'restore', saved: taken([checkedBytes('what was saved', saved)], false)[0] as Uint8Array }));
  }

  undo(): Promise<boolean> {
    return this.#move('undo');
  }

  redo(): Promise<boolean> {
    return this.#move('redo');
  }

  cancel(): void {
    for (const step of this.#given) step.cancel();
  }

  cancelStep(step: Step): void {
    this.#end(step, 'cancel');
  }

  finish(): void {
    const step = [...this.#given].find(({ range, isFinished }) => range && !isFinished);
    if (!step) return;
    step.isFinished = true;
    this.#end(step, 'finish');
  }

  labels(index: number, options?: Parameters<Clip['labels']>[1]): Promise<ClipFrame> {
    return new Promise((resolve, reject) => {
      const { signal } = reading(() => parted(entriesOf(options, ['signal']), [])).call;
      this.#checkOpen();
      commands.frameOf(this, 'frame', index);
      if (signal?.aborted) throw cancelled(signal);
      const leave = () => {
        this.#requests = this.#requests.filter((other) => other !== request);
        signal?.removeEventListener('abort', abort);
      };
      const abort = () => request.reject(cancelled(signal));
      const settling =
        <T>(settle: (value: T) => void) =>
        (value: T) => {
          leave();
          settle(value);
        };
      const request: Request = { index, isParked: false, resolve: settling(resolve), reject: settling(reject) };
      signal?.addEventListener('abort', abort);
      this.#requests.push(request);
      this.#wake();
      void this.#run();
    });
  }

  async shownOf(step: Step): Promise<ClipFrame> {
    if (step.frame === undefined) throw invalidInput('the step is about no frame of its own');
    await Promise.race([step, step.changed]);
    return this.labels(step.frame);
  }

  async annotations(index: number): Promise<ClipAnnotation[]> {
    commands.frameOf(this, 'frame', index);
    return this.#send((clip) => ({ call: 'annotationsOfClip', clip, index }));
  }

  async tracks(): Promise<ClipTracks> {
    const { objects, dropped } = this.#status;
    const { frames } = this;
    const tracks = new Tracks();
    for (const [index, { hasMasks }] of frames.entries()) {
      if (!hasMasks) continue;
      const seen = this.#seen.get(index) ?? (await this.#seenOf(index));
      if (seen) tracks.addSeen(seen);
    }
    tracks.dropped = dropped;
    tracks.names = new Map(objects.flatMap(({ number, name }) => (name === '' ? [] : [[number, name]])));
    const isComplete = frames.length > 1 && frames.every(({ hasMasks }) => hasMasks);
    const isAnnotated = frames.some(({ annotated }) => annotated) || objects.some(({ number, became }) => number !== became);
    if (isComplete && !isAnnotated && !this.#isOneMotion && (tracks.isEmpty || tracks.grounds().length > 0)) {
      const { notesOn } = await import('../clip/notes.js');
      const segment = (first: Pixels, second: Pixels) => this.#segmentPair(first, second);
      tracks.notes = await notesOn(tracks, { length: this.length, read: (index) => this.#parts.frames.read(index), segment });
    }
    return tracks.value();
  }

  save(): Promise<Uint8Array> {
    return this.#send((clip) => ({ call: 'saveClip', clip }));
  }

  subscribe(listener: (event: ClipEvent) => void): () => void {
    if (typeof listener !== 'function') throw invalidInput('the listener must be a function');
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  async close(): Promise<void> {
    const reason = new VeroneseError('clip-closed', 'the clip is closed');
    if (!this.#closing) {
      this.#closing = reason;
      this.#wake();
      // What was given is in the journal.
      await this.#turn;
    }
    await this.#close(reason);
  }

  [Symbol.dispose](): void {
    void this.close();
  }

  #checkOpen(): void {
    const reason = this.#closed ?? this.#closing;
    if (reason) throw reason;
  }

  #close(reason: VeroneseError): Promise<void> {
    if (this.#closed) return this.#journalClosed;
    this.#closing ??= reason;
    this.#closed = reason;
    this.#steps = { ...this.#steps, waiting: 0 };
    this.#wake();
    this.#leave();
    for (const step of this.#given) step.reject(reason);
    this.#given.clear();
    this.#pending.clear();
    for (const { reject } of this.#requests) reject(reason);
    const { writer, journal } = this.#parts;
    this.#emit({ type: 'closed', reason });
    this.#journalClosed = closeJournal(writer, journal);
    return this.#journalClosed;
  }

  /** A segmenter that was closed closes its clips. */
  homeLost(reason: VeroneseError): void {
    if (reason.code === 'cancelled') void this.#close(reason);
  }

  /** Leaves the home, which may be lost. */
  #leave(): void {
    const place = this.#place;
    this.#place = undefined;
    this.#leaveAhead();
    if (!place) return;
    homes.unregister(this);
    leave(place);
  }

  #leaveAhead(): void {
    this.#ahead?.ending.abort();
    this.#ahead = undefined;
  }

  #failed(thrown: unknown): Step {
    const step = new Step(this, {});
    step.reject(thrown);
    return step;
  }

  /** Gives the clip a command, which takes what it needs of the caller's at once. */
  #apply(make: () => ClipCommand, range?: StepRange): Step {
    let command: ClipCommand;
    try {
      this.#checkOpen();
      command = reading(make);
    } catch (thrown) {
      return this.#failed(thrown);
    }
    const step = new Step(this, { range, frame: commands.frameOfCommand(command) });
    step.objects = commands.objectsOfCommand(command);
    this.#wake();
    // A copy: it is given again if the home is lost.
    const task = (clip: number): ClipTask => ({ call: 'applyClip', clip, command: structuredClone(command) });
    this.#given.add(step);
    this.#send<ClipAnswer>(task).then(
      (answer) => {
        step.number = answer.step as number;
        this.#pending.set(step.number, step);
        void this.#answered(answer, step);
        this.#isPaused = false;
        if (step.isCancelled) this.#end(step, 'cancel');
        else if (step.isFinished) this.#end(step, 'finish');
        void this.#run();
      },
      (thrown) => {
        this.#given.delete(step);
        step.reject(thrown);
      },
    );
    return step;
  }

  async #move(what: 'undo' | 'redo'): Promise<boolean> {
    this.#checkOpen();
    this.#wake();
    const answer = await this.#send<ClipAnswer>((clip) => ({ call: 'moveClip', clip, what, step: 0 }));
    await this.#answered(answer);
    void this.#run();
    return answer.done === true;
  }

  /** Ends a step that has not taken effect. */
  #end(step: Step, what: 'cancel' | 'finish'): void {
    if (what === 'cancel') step.isCancelled = true;
    this.#wake();
    // One that is not given yet is ended when it is.
    if (step.number === 0 || !this.#pending.has(step.number)) return;
    this.#send<ClipAnswer>((clip) => ({ call: 'moveClip', clip, what, step: step.number })).then(
      (answer) => {
        void this.#answered(answer);
        void this.#run();
      },
      () => undefined,
    );
  }

  async #segmentPair(first: Pixels, second: Pixels): Promise<Segmentation> {
    // A home that was lost is had again.
    const home = await this.#send<Home>(() => undefined);
    return home.perform({ call: 'segmentPair', frames: [first, second], settings: { quality: 'fast' } }, {}) as Promise<Segmentation>;
  }

  /** What tracks need of a frame; undefined if it has lost its masks meanwhile. */
  async #seenOf(index: number): Promise<Seen | undefined> {
    try {
      return seenIn(await this.labels(index));
    } catch (thrown) {
      if (isCode(thrown, 'invalid-option')) return undefined;
      throw thrown;
    }
  }

  /** Makes a call when those before are answered. Without a task it gives the home. */
  #send<Answer>(task: (clip: number) => ClipTask | undefined): Promise<Answer> {
    const sent = this.#turn.then(() => this.#perform<Answer>(task));
    this.#turn = sent.catch(() => undefined);
    return sent;
  }

  /** Makes a call; if the home is lost, in another one. */
  async #perform<Answer>(task: (clip: number) => ClipTask | undefined): Promise<Answer> {
    for (let attempts = 1; ; attempts++) {
      if (this.#closed) throw this.#closed;
      try {
        const { home, clip } = this.#place ?? (await this.#revive());
        const own = task(clip);
        const answer = own ? await home.perform(own, {}) : home;
        if (answer === null) throw new VeroneseError('internal', 'the clip was lost when another call failed');
        return answer as Answer;
      } catch (thrown) {
        if (this.#closed) throw this.#closed;
        if (isCode(thrown, 'cancelled')) void this.#close(thrown);
        if (!isCode(thrown, 'worker-failed', 'internal')) throw thrown;
        this.#leave();
        this.#lost = thrown;
        if (attempts === 2) throw thrown;
      }
    }
  }

  /** Opens the clip again, from its journal. Steps that had not taken effect go on. */
  async #revive(): Promise<{ home: Home; clip: number }> {
    const { writer } = this.#parts;
    const content = await writer.content();
    const answer = await this.open(content);
    const { used = 0, isDamaged = false, status } = answer;
    if (content && used < content.length) {
      await writer.cut(content, used, isDamaged).catch(() => undefined);
      const lost = new VeroneseError('write-failed', 'the journal cannot be read any more: steps that had not taken effect are lost');
      for (const step of this.#pending.values()) step.reject(lost);
      for (const step of this.#pending.values()) this.#given.delete(step);
      this.#pending.clear();
    }
    this.#emit({ type: 'revived', reason: this.#lost as VeroneseError });
    // What a step has changed that had not taken effect is not there any more.
    const frames = Array.from(status?.flags ?? [], (flag, index) => (flag & HAS_MASKS ? index : -1)).filter((index) => index >= 0);
    void this.#answered({ ...answer, frames });
    return this.#place as { home: Home; clip: number };
  }

  /** Takes in what has happened. Steps are told as settled when the journal has them; resolves then. */
  async #answered(answer: ClipAnswer, step?: Step): Promise<void> {
    if (this.#closed) return;
    const { frames, settled, status, labels, draft, records, wanted } = answer;
    const [undo, redo, waiting] = answer.steps;
    this.#steps = { undo, redo, waiting };
    this.#wanted = wanted;
    const objects = JSON.stringify(this.#status.objects);
    if (status) [this.#status, this.#frames] = [status, undefined];
    for (const index of frames) this.#seen.delete(index);
    if (step?.frame !== undefined && frames.includes(step.frame)) step.mark();
    const ends = settled.map((end) => ({ end, step: this.#taken(end.step, frames) }));
    const dropped = answer.cancelled.map((number) => this.#taken(number, []));
    if (settled.length > 0 || dropped.length > 0) for (const request of this.#requests) request.isParked = false;
    if (labels) this.#label(labels);
    const kept = records ? this.#keep(records, answer.replaces === true) : this.#parts.writer.settled();
    if (status && JSON.stringify(status.objects) !== objects) this.#emit({ type: 'objects' });
    if (frames.length > 0) this.#emit({ type: 'frames', frames });
    if (draft) this.#emit({ type: 'draft', frame: sized(draft, this.#sizeOf(draft)) });
    for (const own of dropped) own?.reject(own.failure ? own.failure.thrown : (own.reason ?? cancelled()));
    if (!records && ends.length === 0) return;
    await kept;
    for (const { end, step } of ends) this.#settle(end, step);
  }

  /** A step that waits no longer. */
  #taken(number: number, frames: readonly number[]): Step | undefined {
    const step = this.#pending.get(number);
    this.#pending.delete(number);
    if (this.#ahead?.step === step) this.#leaveAhead();
    if (!step) return undefined;
    this.#given.delete(step);
    const { range } = step;
    const isIn = (index: number) => range !== undefined && index >= range.first && index <= range.last;
    step.frames = range ? this.frames.flatMap(({ hasMasks }, index) => (hasMasks && isIn(index) ? [index] : [])) : frames;
    if (range && ![...this.#pending.values()].some((other) => other.range)) this.#place?.home.endIdle?.();
    return step;
  }

  #settle({ step: number, changes = [], code, message = '' }: SettledStep, step: Step | undefined): void {
    const failed = code === undefined ? undefined : new VeroneseError(code, message);
    const failure = step?.failure ?? (failed && { thrown: failed });
    if (failure) step?.reject(failure.thrown);
    else step?.resolve(changes);
    const error = failure?.thrown;
    this.#emit({ type: 'settled', step: number, ...(error instanceof VeroneseError && { error }) });
  }

  async #keep(records: Uint8Array, replaces: boolean): Promise<void> {
    try {
      const bytes = await this.#parts.writer.write(records, replaces);
      if (bytes > 0) this.#emit({ type: 'kept', bytes });
    } catch (thrown) {
      const error =
        thrown instanceof VeroneseError
          ? thrown
          : new VeroneseError('write-failed', `the journal cannot be written: ${(thrown as Error)?.message}`, { cause: thrown });
      this.#emit({ type: 'unkept', error });
    }
  }

  #label(found: LabelledFrame): void {
    const frame = sized(found, this.#sizeOf(found));
    this.#seen.set(frame.index, seenIn(frame));
    for (const { index, resolve } of this.#requests) if (index === frame.index) resolve(structuredClone(frame));
  }

  /** The clip's size, or that of the frame which was read last while a range of another size is segmented. */
  #sizeOf({ labels }: LabelledFrame): { width: number; height: number } {
    const { width, height } = this.#status;
    return width * height === labels.length ? { width, height } : this.#size;
  }

  /** Gives the clip what it wants, until it wants nothing. */
  async #run(): Promise<void> {
    if (this.#isRunning) return;
    this.#isRunning = true;
    try {
      while (!this.#closing) {
        // What was given meanwhile goes first.
        await this.#turn;
        const request = this.#requests.find(({ isParked }) => !isParked);
        const wanted = this.#wanted;
        if (request && !(wanted?.stage === 'labels' && wanted.frame === request.index)) await this.#ask(request);
        else if (wanted && !this.#isPaused) await this.#take(wanted);
        else break;
      }
    } catch (thrown) {
      // A home that cannot be had, or a clip that was closed.
      if (!this.#closed)
        void this.#close(thrown instanceof VeroneseError ? thrown : new VeroneseError('internal', String(thrown), { cause: thrown }));
    } finally {
      this.#isRunning = false;
    }
  }

  /** Asks for the labels of a frame. */
  async #ask(request: Request): Promise<void> {
    const { index } = request;
    const answer = await this.#send<ClipAnswer>((clip) => ({ call: 'lookAtClip', clip, index }));
    void this.#answered(answer);
    if (answer.labels || answer.wanted?.stage === 'labels') return;
    const isComing = [...this.#pending.values()].some(({ range }) => range && index >= range.first && index <= range.last);
    if (isComing) request.isParked = true;
    else request.reject(new VeroneseError('invalid-option', `option 'frame': frame ${index} has no masks: segment it first`));
  }

  async #take(wanted: WantedFrame): Promise<void> {
    const { frame: index, stage, step: number, isCached } = wanted;
    const step = this.#pending.get(number);
    // A range that was begun before the clip was opened again, and for which no annotation waits: its solved pairs are kept.
    if (stage === 'pairs' && !step && this.#steps.waiting === 1) return this.#drop(number);
    const woken = new Promise<undefined>((resolve) => (this.#wake = () => resolve(undefined)));
    this.#report(wanted, step);
    let solved: Solved | undefined;
    try {
      if (!isCached || stage === 'pairs') solved = await Promise.race([this.#next(wanted, step), woken]);
    } catch (thrown) {
      this.#reading = undefined;
      return this.#unreadable(wanted, step, thrown);
    }
    const isRead = solved !== undefined || (isCached && stage !== 'pairs');
    if (!isRead || !isSame(this.#wanted, wanted) || this.#closing) return;
    const { width, height } = solved?.frame ?? this.#size;
    this.#size = { width, height };
    try {
      // A copy: pairs may still be solved with it, or it is given again.
      const copy = () => solved && { width, height, data: solved.frame.data.slice() };
      const draft = step?.range?.drafts === true;
      const task = (clip: number): ClipTask => ({ call: 'takeClip', clip, index, frame: copy(), solved: solved?.pairs?.slice(), draft });
      const answer = await this.#send<ClipAnswer | undefined>(task);
      this.#reading = undefined;
      if (answer) void this.#answered(answer, step);
      else this.#wanted = { ...wanted, isCached: false };
    } catch (thrown) {
      if (this.#closed) throw thrown;
      if (isCode(thrown, 'worker-failed', 'internal')) return this.#giveUp(wanted, step, thrown);
      const isOfSize = isCode(thrown, 'frame-size-mismatch');
      return this.#unreadable(
        wanted,
        step,
        isOfSize ? new VeroneseError(thrown.code, `frame ${index}: ${thrown.message}`, { cause: thrown }) : thrown,
      );
    }
  }

  /** A frame that is wanted; one of a range with its pairs, some frames ahead. */
  #next({ frame: index, stage }: WantedFrame, step: Step | undefined): Promise<Solved> {
    const { range } = step ?? {};
    // The frames beside a range are wanted for it as well.
    if (stage === 'pairs' && step && range && index >= range.first && index <= range.last) {
      if (this.#ahead?.step !== step) {
        const ending = new AbortController();
        this.#ahead = { step, ending, frames: this.#aheadOf(range, ending.signal) };
      }
      const solved = new Set(this.#status.solved);
      return this.#ahead.frames.at(index, (index) => solved.has(index));
    }
    if (this.#reading?.index !== index) this.#reading = { index, frame: this.#parts.frames.read(index) };
    const { frame } = this.#reading;
    // Whoever wants it hears of it.
    frame.catch(() => undefined);
    return frame.then((frame) => ({ frame, pairs: undefined }));
  }

  #aheadOf({ options: settings, last, pairs: given }: StepRange, signal: AbortSignal): Ahead {
    const { beside, anywhere, size = 1 } = this.#place?.home ?? {};
    // Where there are masks to correct, their home is left free.
    const perform = this.#status.flags.some((flag) => flag & HAS_MASKS) ? beside : anywhere;
    const copied = ({ data, ...size }: Pixels) => ({ ...size, data: data.slice() });
    const isShared = perform !== undefined && size > 1;
    const solve: Solve = async (index, before, frame) => {
      const known = await given?.(index);
      if (known !== undefined) return checkedBytes(`the pairs of frame ${index}`, known).slice();
      if (!isShared) return undefined;
      return perform({ call: 'solvePair', frames: [copied(before), copied(frame)], settings }, { signal }) as Promise<Uint8Array>;
    };
    return new Ahead(
      (index) => this.#parts.frames.read(index),
      isShared || given ? solve : undefined,
      isShared ? this.#room(size) : 1,
      last,
    );
  }

  /** How many frames there is room for, of as many as there are workers. */
  #room(workers: number): number {
    const { width, height } = this.#size;
    return Math.max(1, Math.min(workers, Math.floor(MOST_AHEAD / Math.max(1, 4 * width * height))));
  }

  async #drop(number: number): Promise<void> {
    void this.#answered(await this.#send<ClipAnswer>((clip) => ({ call: 'moveClip', clip, what: 'cancel', step: number })));
  }

  /** A frame cannot be read, or is another one than before: the labels are not known, the step is taken back, the range ends before it. */
  async #unreadable({ frame: index, stage, step: number }: WantedFrame, step: Step | undefined, thrown: unknown): Promise<void> {
    if (stage === 'labels') {
      for (const { index: own, reject } of this.#requests) if (own === index) reject(thrown);
      void this.#answered(await this.#send<ClipAnswer>((clip) => ({ call: 'lookAtClip', clip, index: undefined })));
      return;
    }
    // What was given before the clip was opened again is not lost for that.
    if (!step) {
      this.#isPaused = true;
      this.#emit({
        type: 'paused',
        frame: index,
        error:
          thrown instanceof VeroneseError
            ? thrown
            : new VeroneseError('unreadable-file', `frame ${index}: ${(thrown as Error)?.message}`, { cause: thrown }),
      });
      return;
    }
    const failures = ++step.failures;
    step.failure ??= { thrown };
    this.#leaveAhead();
    // The frame before a range can be done without; then the frames end.
    const what = stage === 'pairs' && failures <= 2 ? 'finish' : 'cancel';
    void this.#answered(await this.#send<ClipAnswer>((clip) => ({ call: 'moveClip', clip, what, step: number })));
  }

  /** Two homes were lost with the same frame: what wanted it is given up. */
  async #giveUp({ frame: index, stage, step: number }: WantedFrame, step: Step | undefined, thrown: VeroneseError): Promise<void> {
    if (stage === 'labels') for (const { index: own, reject } of this.#requests) if (own === index) reject(thrown);
    if (stage === 'labels') return;
    if (step) step.failure ??= { thrown };
    return this.#drop(number);
  }

  #report({ frame, stage }: WantedFrame, step: Step | undefined): void {
    const { range } = step ?? {};
    if (stage === 'annotations') this.#emit({ type: 'progress', stage, frame, done: step ? step.visits++ : 0, of: undefined });
    else if (stage === 'pairs' && range && frame >= range.first && frame <= range.last) {
      this.#emit({ type: 'progress', stage, frame, done: frame - range.first, of: range.last - range.first + 1 });
    }
  }

  #emit(event: ClipEvent): void {
    for (const listener of this.#listeners) {
      try {
        listener(event);
      } catch (thrown) {
        // It is not the clip's, and nothing else would tell.
        void Promise.reject(thrown);
      }
    }
  }
}

/** Frees the homes and journals of clips that nobody has any more. */
const homes = new FinalizationRegistry<{ home: Home; clip: number; journal: ClipJournal; writer: JournalWriter }>(
  ({ journal, writer, ...place }) => {
    leave(place);
    void closeJournal(writer, journal);
  },
);

function leave({ home, clip }: { home: Home; clip: number }): void {
  home.perform({ call: 'closeClip', clip }, {}).then(home.release, home.release);
}

/** Tries once more to write what could not be written. What cannot be closed is left to its end. */
async function closeJournal(writer: JournalWriter, journal: ClipJournal): Promise<void> {
  await writer.flush().catch(() => undefined);
  await Promise.resolve(journal.close?.()).catch(() => undefined);
}

function isSame(one: WantedFrame | undefined, other: WantedFrame): boolean {
  return one?.frame === other.frame && one.stage === other.stage && one.step === other.step;
}

function isCode(thrown: unknown, ...codes: string[]): thrown is VeroneseError {
  return thrown instanceof VeroneseError && codes.includes(thrown.code);
}
