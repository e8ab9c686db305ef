//! Keeps the work in this browser while it goes on, and finds it when the same frames are opened again. Only what watches is loaded with
//! the page.

import { codeOf, isStorageFull, sentenceOf } from '../common/errors.js';
import { loaded } from '../common/loaded.js';
import { inFileNames } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { type Sample, sampleCalled } from '../frames/samples.js';
import { type FramePair, timelineOf } from '../state/pair.js';
import { type Keeping, NOTHING_KEPT, type Refusal, type State, type Store } from '../state/state.js';
import { type SolvedPairs, isUnsavedClip } from '../state/tracked.js';
import type { Project } from './project.js';
import type { Listed } from './shelf.js';

/** How long a change waits for others, milliseconds; and one by a run while it goes on, which changes all the time. */
const SOON = 500;
const LATER = 10_000;

/** The parts of a clip that a person changes, and those that runs change. */
const BY_PERSON = ['names', 'classes', 'colours', 'locked', 'accepted', 'exact', 'range', 'past', 'future', 'pending'] as const;
const BY_RUNS = ['frames', 'spans', 'solved', 'run'] as const;

type Shelf = typeof import('./shelf.js');

export class Projects {
  readonly #store: Store;
  /** The solved pairs of clips, by fingerprint: they are not in the state. */
  readonly #pairs: Map<string, SolvedPairs>;
  /** Clips whose changes are not written yet, by fingerprint. */
  readonly #changed = new Set<string>();
  /** Projects of files, until their frames are opened. */
  readonly #opened = new Map<string, Project>();
  /** Clips that need not be looked for again. */
  readonly #known = new Set<string>();
  /** The files that the frames of each were opened from. */
  readonly #files = new Map<string, readonly File[]>();
  /** Whether the work on each is kept. That on what is open is in the state. */
  readonly #keeping = new Map<string, Keeping>();
  /** The last picture of each. */
  readonly #thumbnails = new Map<string, string>();
  /** When the project of each was looked for, as an ISO 8601 date. What is saved later is another tab's. */
  readonly #lookedFor = new Map<string, string>();
  /** Loaded when it is needed. */
  #shelf: Shelf | null = null;
  #timer = 0;
  #due = Infinity;
  #writing = false;
  /** Ends when all is written, with the copies of frames. */
  #written: Promise<unknown> = Promise.resolve();

  constructor(store: Store, pairs: Map<string, SolvedPairs>) {
    this.#store = store;
    this.#pairs = pairs;
    store.subscribe((now, before) => this.#watch(now, before));
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'hidden') this.#writeNow();
    });
  }

  /** Whether there may be work to continue. */
  async mayBeKept(): Promise<boolean> {
    return !(await isNothingKept());
  }

  /** The frames of the work that was kept last: a sample, or files; `null` if there is none, or another tab has it. */
  async last(): Promise<Sample | readonly File[] | null> {
    if (await isNothingKept()) return null;
    try {
      const { framesOf, isOwned, list } = await this.#load();
      const [newest] = await list();
      const header = newest?.header ?? null;
      if (newest === undefined || header === null || (await isOwned(header.of))) return null;
      if (header.sample !== undefined) return sampleCalled(header.sample);
      return newest.hasFrames ? await framesOf(newest.file) : null;
    } catch {
      return null;
    }
  }

  /** Opens a project's file. Throws a `PageError`. */
  async open(file: File): Promise<Project> {
    const { projectFromFile } = await this.#load();
    const project = await projectFromFile(file, file.name);
    this.#opened.set(project.of, project);
    return project;
  }

  /** The open clip was opened from these files. */
  comeFrom(files: readonly File[]): void {
    const of = openIn(this.#store.get());
    if (of === undefined) return;
    this.#files.set(of, files);
    // It is kept from the first moment, so that a reload finds it.
    this.#touch(of, SOON);
  }

  /** The project of these frames, if it is not in the state already. */
  async find(pair: FramePair): Promise<Project | null> {
    const clip = timelineOf(pair)?.clip;
    if (clip === undefined) return null;
    const { fingerprint: of, name, count } = clip;
    const opened = this.#opened.get(of);
    if (opened === undefined && this.#known.has(of)) return null;
    this.#lookedFor.set(of, new Date().toISOString());
    if (opened === undefined && (await isNothingKept())) return null;
    try {
      const project = opened ?? (await (await this.#load()).get(of, name));
      // Browsers that read a video approximately may count other frames.
      if (project === null || project.frames === count) return project;
      this.#store.say(strings.projects.otherFrames(name, project.frames, count), 'frame-count-mismatch');
    } catch (error) {
      const code = codeOf(error);
      // What has no code comes from the browser.
      if (code === 'unexpected') this.#store.say(strings.projects.refused, 'storage-refused');
      else this.#store.say(sentenceOf(error), code);
    }
    return null;
  }

  /** Puts what was found for these frames, which are about to be shown, into the state. */
  restore(project: Project | null, pair: FramePair): void {
    const clip = timelineOf(pair)?.clip;
    if (clip !== undefined) this.#known.add(clip.fingerprint);
    if (project === null || this.#shelf === null) return;
    const { withProject } = this.#shelf;
    const isOfFile = this.#opened.delete(project.of);
    if (project.thumbnail !== undefined) this.#thumbnails.set(project.of, project.thumbnail);
    if (project.clip.solved) this.#pairs.set(project.of, project.clip.solved);
    this.#store.set(withProject(this.#store.get(), project, pair));
    // Of a file it is not known yet whether the browser keeps it.
    if (!isOfFile) this.#keeps(project.of);
    this.#touch(project.of, SOON);
  }

  /** The work on what is open, as a file; `null` if there is none. */
  async file(): Promise<{ readonly name: string; readonly content: Blob } | null> {
    const shelf = await this.#load();
    const { fileOf, withSaved } = shelf;
    const project = await this.#projectOf(openIn(this.#store.get()) ?? '', shelf);
    if (project === null) return null;
    const content = await fileOf(project, new Date());
    this.#store.set(withSaved(this.#store.get(), project));
    return { name: `${inFileNames(project.name)}.veronese`, content };
  }

  /** The work on this clip, with a new picture if it is on screen. */
  async #projectOf(of: string, { projectFrom, thumbnailOf }: Shelf): Promise<Project | null> {
    const state = this.#store.get();
    const project = projectFrom(state, of, this.#pairs);
    if (project === null) return null;
    const seen = openIn(state) === of ? await thumbnailOf(state).catch(() => null) : null;
    const thumbnail = seen ?? this.#thumbnails.get(of);
    if (thumbnail !== undefined) this.#thumbnails.set(of, thumbnail);
    return { ...project, thumbnail };
  }

  /** Removes a project that the browser keeps, also what is about to be written of it. The work itself stays until the page is left. */
  async forget({ file, header }: Listed): Promise<void> {
    if (header !== null) this.#changed.delete(header.of);
    await this.#written;
    const { remove, withoutSaved } = await this.#load();
    await remove(file);
    if (header === null) return;
    this.#store.set(withoutSaved(this.#store.get(), header.of));
    this.#tell(header.of, NOTHING_KEPT);
  }

  async #load(): Promise<Shelf> {
    return (this.#shelf ??= await loaded(() => import('./shelf.js')));
  }

  #watch(now: State, before: State): void {
    const keeping = openIn(now) === openIn(before) ? now.keeping : (this.#keeping.get(openIn(now) ?? '') ?? NOTHING_KEPT);
    if (keeping !== now.keeping) this.#store.set({ keeping });
    const [clip, clipBefore] = [now.tracked, before.tracked];
    if (clip === null || clip.clip !== clipBefore?.clip) return;
    const ticked = now.look.kind === 'objects' && before.look.kind === 'objects' && now.look.hidden !== before.look.hidden;
    const listed = now.classList !== before.classList;
    const byPerson = ticked || listed || BY_PERSON.some((part) => clip[part] !== clipBefore[part]);
    // While corrections are carried, what is written is what was said.
    const byRun = clip.pending === null && BY_RUNS.some((part) => clip[part] !== clipBefore[part]);
    if (!byPerson && !byRun) return;
    // The page segments a sample by itself: that is not kept.
    if (clip.solved > 0 && (!clip.clip.sample || isUnsavedClip(clip))) this.#touch(clip.clip.fingerprint, byPerson || clip.run.phase !== 'working' ? SOON : LATER);
  }

  #touch(of: string, delay: number): void {
    this.#changed.add(of);
    const keeping = this.#keeping.get(of);
    if (keeping?.is === 'kept' && !keeping.waits) this.#tell(of, { ...keeping, waits: true });
    const due = performance.now() + delay;
    if (due >= this.#due) return;
    clearTimeout(this.#timer);
    this.#due = due;
    this.#timer = window.setTimeout(() => this.#writeNow(), delay);
  }

  #writeNow(): void {
    this.#written = Promise.all([this.#written, this.#write()]);
  }

  /** The clips that can be written: not one between two states, whose masks do not belong together. */
  #ready(): string[] {
    const { tracked } = this.#store.get();
    const between = tracked !== null && tracked.run.phase === 'working' && tracked.past.length > 0 && tracked.spans.length === 0;
    return [...this.#changed].filter((of) => !between || of !== tracked.clip.fingerprint);
  }

  async #write(): Promise<void> {
    clearTimeout(this.#timer);
    this.#due = Infinity;
    if (this.#writing || this.#ready().length === 0) return;
    this.#writing = true;
    const written: Project[] = [];
    for (const of of this.#ready()) {
      this.#changed.delete(of);
      try {
        const project = await this.#put(of);
        if (project !== null) written.push(project);
      } catch (error) {
        const full = isStorageFull(error);
        this.#refuse(of, full ? strings.projects.full : strings.projects.refused, full ? 'storage-full' : 'storage-refused');
      }
    }
    this.#writing = false;
    const [next] = this.#ready();
    if (next !== undefined) this.#touch(next, SOON);
    await Promise.all(written.map((project) => this.#keepFrames(project)));
  }

  /** Writes the project of this clip and returns it; `null` if there is none, or another tab keeps it. */
  async #put(of: string): Promise<Project | null> {
    const shelf = await this.#load();
    const { owns, put, savedAt, withSaved } = shelf;
    const project = await this.#projectOf(of, shelf);
    if (project === null) return null;
    if (!(await owns(of, async () => (await savedAt(of)) <= (this.#lookedFor.get(of) ?? '')))) {
      this.#refuse(of, strings.projects.elsewhere(project.name), 'open-elsewhere');
      return null;
    }
    await put(project);
    this.#store.set(withSaved(this.#store.get(), project));
    this.#keeps(of);
    return project;
  }

  /** Keeps a copy of the frames. A sample needs none. */
  async #keepFrames({ of, sample }: Project): Promise<void> {
    const { putFrames } = await this.#load();
    const files = this.#files.get(of);
    const kept = sample !== undefined || (files !== undefined && (await putFrames(of, files)));
    const keeping = this.#keeping.get(of);
    if (keeping?.is === 'kept' && keeping.without === kept) this.#tell(of, { ...keeping, without: !kept });
  }

  #keeps(of: string): void {
    const before = this.#keeping.get(of);
    this.#tell(of, { is: 'kept', at: Date.now(), without: before?.is === 'kept' && before.without, waits: this.#changed.has(of) });
  }

  /** Nothing is lost: the work is open still, and leaving asks. The next change tries again. */
  #refuse(of: string, sentence: string, code: Refusal): void {
    if (this.#keeping.get(of)?.is === 'refused') return;
    this.#tell(of, { is: 'refused', code });
    this.#store.say(sentence, code);
  }

  #tell(of: string, keeping: Keeping): void {
    this.#keeping.set(of, keeping);
    if (openIn(this.#store.get()) === of) this.#store.set({ keeping });
  }
}

/** The fingerprint of the clip that is open. */
function openIn({ tracked }: State): string | undefined {
  return tracked?.clip.fingerprint;
}

/** Whether nothing can be found, so that a first visit need not look. */
async function isNothingKept(): Promise<boolean> {
  try {
    if (!('createWritable' in FileSystemFileHandle.prototype)) return false; // what is kept is in a database
    await (await navigator.storage.getDirectory()).getDirectoryHandle('projects');
    return false;
  } catch (error) {
    return error instanceof Error && error.name === 'NotFoundError';
  }
}
