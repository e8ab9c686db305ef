//! Keeps the work in this browser while it goes on, and finds it when the same frames are opened again. The work itself is the journal of the clip,
//! which the clip writes; here is what is kept beside it, and where.

import type { ClipJournal } from 'veronese';
import { PageError, codeOf, isStorageFull, sentenceOf } from '../common/errors.js';
import { loaded } from '../common/loaded.js';
import { inFileNames } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { type Sample, sampleCalled } from '../frames/samples.js';
import { type FramePair, timelineOf } from '../state/pair.js';
import { type Keeping, NOTHING_KEPT, type Refusal, type State, type Store } from '../state/state.js';
import { isAnnotated } from '../state/tracked.js';
import { isNothingKept } from './database.js';
import type { Header, Project } from './file.js';
import type { PageJournal } from './journal.js';
import type { Listed } from './shelf.js';
import type { Keeper, Remembered, Work } from './work.js';

/** How long a change of what is beside the journal waits for others, milliseconds. */
const SOON = 500;

type Shelf = typeof import('./shelf.js');

export class Projects {
  readonly #store: Store;
  /** The journals of clips that were open, by fingerprint. */
  readonly #journals = new Map<string, Promise<PageJournal>>();
  /** What was written of clips whose journals are not loaded. */
  readonly #early = new Map<string, Uint8Array[]>();
  /** What is known of clips that were open, or of a project that is about to be. */
  readonly #headers = new Map<string, Header>();
  /** Projects of files, until their frames are opened. */
  readonly #opened = new Map<string, Project>();
  /** Clips that were left with work that is not kept. */
  readonly #unsaved = new Set<string>();
  /** The files that the frames of each were opened from. */
  readonly #files = new Map<string, readonly File[]>();
  /** Whether the work on each is kept. That on what is open is in the state. */
  readonly #keeping = new Map<string, Keeping>();
  #shelf: Promise<Shelf> | null = null;
  #timer = 0;
  /** Ends when all is written, with the copies of frames. */
  #written: Promise<unknown> = Promise.resolve();
  /** The clip that is open. */
  living: () => Work | null = () => null;

  constructor(store: Store) {
    this.#store = store;
    store.subscribe((now, before) => this.#watch(now, before));
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'hidden') void this.#writeNow();
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
      if (newest === undefined || (await isOwned(newest.header.of))) return null;
      if (newest.header.sample !== undefined) return sampleCalled(newest.header.sample);
      return newest.hasFrames ? await framesOf(newest.header.of) : null;
    } catch {
      return null;
    }
  }

  /** Opens a project's file. Throws a `PageError`. */
  async open(file: File): Promise<Header> {
    const { projectFromFile } = await this.#load();
    const project = await projectFromFile(file, file.name);
    this.#opened.set(project.header.of, project);
    return project.header;
  }

  /** The open clip was opened from these files. It is kept from the first moment, so that a reload finds it. */
  comeFrom(files: readonly File[]): void {
    const of = openIn(this.#store.get());
    if (of === undefined) return;
    this.#files.set(of, files);
    this.#keep(of);
  }

  /** The project of these frames, if they are not open already, or are of a file. */
  async find(pair: FramePair): Promise<Header | null> {
    const clip = timelineOf(pair)?.clip;
    const { tracked } = this.#store.get();
    if (clip === undefined) return null;
    const { fingerprint: of, name, count } = clip;
    const opened = this.#opened.get(of)?.header ?? null;
    if (opened === null && tracked?.clip === clip) return null;
    if (opened === null && !this.#headers.has(of) && (await isNothingKept())) return null;
    // A clip that was just left is found as it was left.
    await this.#written;
    try {
      const header = opened ?? this.#headers.get(of) ?? (await (await this.#load()).headerOf(of));
      // Browsers may count the frames of a video differently.
      if (header === null || header.frames === count) return header;
      this.#store.say(strings.projects.otherFrames(name, header.frames, count), 'frame-count-mismatch');
    } catch (error) {
      const code = codeOf(error);
      // What has no code comes from the browser.
      if (code === 'unexpected') this.#store.say(strings.projects.refused, 'storage-refused');
      else this.#store.say(sentenceOf(error), code);
    }
    return null;
  }

  /** What is remembered of a clip that is about to be opened. Work of a file becomes its own, or if it has some already, one more step of it. */
  async remembered({ fingerprint: of, name }: Work['clip']): Promise<Remembered> {
    const shelf = await this.#load();
    const project = this.#opened.get(of);
    this.#opened.delete(of);
    const journal = await this.#journalOf(of, name);
    const header = this.#headers.get(of) ?? (await shelf.headerOf(of).catch(() => null));
    const { found = 0, at = 0, settings, range } = project?.header ?? header ?? {};
    const common = { found, at, markUnknown: settings?.markUnknown, ...(range && { range }) };
    if (project === undefined) return { ...common, known: await shelf.masksOf(of).catch(() => null) };
    const { tracked } = this.#store.get();
    const isWorked = header?.annotated === true || (tracked?.clip.fingerprint === of && isAnnotated(tracked));
    if (isWorked) return { ...common, found: header?.found ?? 0, restored: project.journal };
    await journal.replace(project.journal);
    return common;
  }

  /** Puts what is known beside the journal into the state, with the clip of this pair. */
  restore(header: Header): void {
    const { of, settings, classList: saved } = header;
    const { classList } = this.#store.get();
    this.#headers.set(of, header);
    // The project's classes keep their numbers.
    this.#store.set({ settings, classList: [...new Set([...saved, ...classList])] });
    this.#keep(of);
  }

  /** Where a clip is kept. */
  keeperOf({ fingerprint: of, name }: Work['clip']): Keeper {
    return {
      journal: new LateJournal(this.#earlyOf(of), () => this.#journals.get(of), async () => ((await isNothingKept()) ? undefined : this.#journalOf(of, name))),
      said: () => {
        this.#keep(of);
        const keeping = this.#keeping.get(of);
        if (keeping?.is === 'kept') this.#tell(of, { ...keeping, waits: true });
      },
      settled: () => void this.#journals.get(of)?.then((journal) => journal.settled()).then(() => this.#touch()),
    };
  }

  /** The work on a clip that is being left. */
  leave(living: Work): void {
    const { fingerprint: of } = living.clip;
    if (openIn(this.#store.get()) === of && this.#isUnsavedNow) this.#unsaved.add(of);
    void this.#writeNow(living);
  }

  /** The work on what is open, as a file; `null` if there is none. */
  async file(): Promise<{ readonly name: string; readonly content: Blob } | null> {
    const { fileOf } = await this.#load();
    const living = this.living();
    const header = living && (await this.#headerOf(this.#store.get(), living));
    if (living === null || header === null || this.#store.get().tracked?.status.some(({ hasMasks }) => hasMasks) !== true) return null;
    const journal = await living.save();
    this.exported();
    return { name: `${inFileNames(header.name)}.veronese`, content: await fileOf({ header: { ...header, bytes: journal.length }, journal }) };
  }

  /** Removes a project that the browser keeps. The work itself stays until the page is left. */
  async forget({ header }: Listed): Promise<void> {
    const { of } = header;
    const { isOwn, isOwned, remove } = await this.#load();
    if (!isOwn(of) && (await isOwned(of))) throw new PageError('open-elsewhere', strings.projects.elsewhere(header.name));
    this.#tell(of, NOTHING_KEPT);
    await this.#written;
    const journal = await this.#journals.get(of);
    if (journal === undefined) await remove(of);
    else await journal.forgotten(() => remove(of));
    this.#headers.delete(of);
    this.#unsaved.delete(of);
  }

  /** The work on what is open was taken away as a file. */
  exported(): void {
    const { tracked } = this.#store.get();
    if (tracked !== null) this.#store.clip({ exported: { status: tracked.status, objects: tracked.objects } });
  }

  /** Whether leaving the page would lose what a person did. */
  get isUnsaved(): boolean {
    const of = openIn(this.#store.get());
    return this.#isUnsavedNow || [...this.#unsaved].some((left) => left !== of);
  }

  get #isUnsavedNow(): boolean {
    const { tracked, keeping } = this.#store.get();
    if (tracked === null || (keeping.is === 'kept' && !keeping.waits) || !isAnnotated(tracked)) return false;
    return tracked.exported?.status !== tracked.status || tracked.exported.objects !== tracked.objects;
  }

  async #load(): Promise<Shelf> {
    this.#shelf ??= loaded(() => import('./shelf.js'));
    this.#shelf.catch(() => (this.#shelf = null));
    return this.#shelf;
  }

  #journalOf(of: string, name: string): Promise<PageJournal> {
    const journal = this.#journals.get(of) ?? this.#load().then(({ PageJournal }) => new PageJournal(of, name, this.#earlyOf(of), { kept: () => this.#keeps(of), refused: (error) => this.#refuse(of, error) }));
    this.#journals.set(of, journal);
    journal.catch(() => this.#journals.delete(of));
    return journal;
  }

  #earlyOf(of: string): Uint8Array[] {
    const early = this.#early.get(of) ?? [];
    this.#early.set(of, early);
    return early;
  }

  #watch(now: State, before: State): void {
    const of = openIn(now);
    const keeping = of === openIn(before) ? now.keeping : (this.#keeping.get(of ?? '') ?? NOTHING_KEPT);
    if (keeping !== now.keeping) this.#store.set({ keeping });
    const [clip, clipBefore] = [now.tracked, before.tracked];
    if (of === undefined || clip?.clip !== clipBefore?.clip) return;
    const ticked = now.look.hidden !== before.look.hidden;
    const isOther = ticked || now.classList !== before.classList || now.settings !== before.settings || clip?.range !== clipBefore?.range || now.timeline?.first !== before.timeline?.first;
    if (isOther && this.#keeping.get(of)?.is === 'kept') this.#touch();
  }

  /** From now on the work on this clip is kept. */
  #keep(of: string): void {
    const { tracked } = this.#store.get();
    const journal = this.#journalOf(of, tracked?.clip.fingerprint === of ? tracked.clip.name : of);
    journal.then((kept) => kept.keep()).catch((error: unknown) => this.#refuse(of, error));
  }

  /** The journal is written; what is beside it follows, the first time at once. */
  #keeps(of: string): void {
    if (this.#keeping.get(of)?.is === 'kept') this.#touch();
    else void this.#writeNow();
  }

  /** Nothing is lost: the work is open still, and leaving asks. The next change tries again. */
  #refuse(of: string, error: unknown): void {
    if (this.#keeping.get(of)?.is === 'refused') return;
    const isElsewhere = codeOf(error) === 'open-elsewhere';
    const code: Refusal = isElsewhere ? 'open-elsewhere' : isStorageFull(error) ? 'storage-full' : 'storage-refused';
    const sentence = error instanceof PageError ? error.message : code === 'storage-full' ? strings.projects.full : strings.projects.refused;
    this.#tell(of, { is: 'refused', code });
    this.#store.say(sentence, code);
  }

  #tell(of: string, keeping: Keeping): void {
    this.#keeping.set(of, keeping);
    if (openIn(this.#store.get()) === of) this.#store.set({ keeping });
  }

  /** What is beside the journal is written soon. */
  #touch(): void {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#writeNow(), SOON);
  }

  #writeNow(living = this.living()): Promise<unknown> {
    clearTimeout(this.#timer);
    const state = this.#store.get();
    if (living === null || state.tracked?.clip !== living.clip) return this.#written;
    this.#remember(living);
    return (this.#written = this.#written.then(() => this.#write(state, living)).catch(() => undefined));
  }

  async #write(state: State, living: Work): Promise<void> {
    const header = await this.#headerOf(state, living);
    const journal = await this.#journals.get(header?.of ?? '');
    if (header === null || journal?.isKept !== true) return;
    const { of, sample } = header;
    const { put, putFrames } = await this.#load();
    try {
      await put(header);
    } catch (error) {
      return this.#refuse(of, error);
    }
    const tell = (without: boolean): void => {
      const before = this.#keeping.get(of);
      if (before?.is === 'kept' || journal.isWritten) this.#tell(of, { is: 'kept', at: Date.now(), without, waits: !journal.isWritten });
    };
    const before = this.#keeping.get(of);
    tell(before?.is === 'kept' && before.without);
    // Whoever asks before the page is left looks again.
    if (this.#unsaved.delete(of)) this.#store.set({});
    const files = this.#files.get(of);
    const hasFrames = sample !== undefined || (files !== undefined && (await putFrames(of, files)));
    if (journal.isKept) tell(!hasFrames);
  }

  /** Masks that are known, so that they need not be made again. */
  #remember({ masks, clip: { fingerprint: of } }: Work): void {
    if (this.#keeping.get(of)?.is !== 'kept') return;
    const put = async (): Promise<void> => (await this.#load()).putMasks(of, masks);
    this.#written = Promise.all([this.#written, put().catch(() => undefined)]);
  }

  /** What is known of the clip that is open; `null` if there is none. */
  async #headerOf(state: State, living: Work): Promise<Header | null> {
    const { headerFrom, thumbnailOf } = await this.#load();
    const { tracked, settings, classList, timeline, look } = state;
    if (tracked === null) return null;
    const { fingerprint: of, name, count: frames, sample } = tracked.clip;
    const journal = await this.#journalOf(of, name);
    const thumbnail = (await thumbnailOf(state).catch(() => null)) ?? this.#headers.get(of)?.thumbnail;
    const header = headerFrom({
      of,
      name,
      frames,
      ...(sample && { sample: sample.id }),
      saved: new Date().toISOString(),
      thumbnail,
      settings,
      classList,
      range: tracked.range,
      at: timeline?.first ?? 0,
      hidden: [...look.hidden],
      found: living.found,
      annotated: isAnnotated(tracked),
      bytes: journal.bytes,
    });
    this.#headers.set(of, header);
    return header;
  }
}

/** A journal in memory, until there is reason to load the one that is kept. That goes on with what was written before. */
class LateJournal implements ClipJournal {
  constructor(
    readonly early: Uint8Array[],
    readonly loaded: () => Promise<PageJournal> | undefined,
    readonly load: () => Promise<PageJournal | undefined>,
  ) {}

  async read(): Promise<Uint8Array | undefined> {
    const journal = await (this.loaded() ?? (this.early.length > 0 ? undefined : this.load()));
    if (journal !== undefined) return journal.read();
    return this.early.length > 0 ? new Uint8Array(await new Blob(this.early as BlobPart[]).arrayBuffer()) : undefined;
  }

  async append(records: Uint8Array): Promise<void> {
    const journal = this.loaded();
    if (journal === undefined) this.early.push(records);
    else await (await journal).append(records);
  }

  async replace(saved: Uint8Array): Promise<void> {
    const journal = this.loaded();
    if (journal === undefined) this.early.splice(0, Infinity, saved);
    else await (await journal).replace(saved);
  }

  async keepDamaged(content: Uint8Array): Promise<void> {
    await (await this.loaded())?.keepDamaged(content);
  }
}

/** The fingerprint of the clip that is open. */
function openIn({ tracked }: State): string | undefined {
  return tracked?.clip.fingerprint;
}
