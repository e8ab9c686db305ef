//! Opens samples, images, folders, videos, projects, masks for the frames on screen, lists of classes. It decides what files
//! are, and reads them; it keeps nothing.

import type { Clip } from '../clips/clip.js';
import { openFolder } from '../clips/folder.js';
import { openClip } from '../clips/open.js';
import { PageError } from '../common/errors.js';
import { loaded } from '../common/loaded.js';
import { strings } from '../common/strings.js';
import { type ImageFolder, foldersOf, likelyFrames, selectOpenable, withPath } from '../frames/files.js';
import { fetchImage, filesOf, frameFromFile } from '../frames/frame.js';
import { SAMPLES, type Sample } from '../frames/samples.js';
import type { Header } from '../projects/file.js';
import type { Projects } from '../projects/projects.js';
import type { FramePair, LoadedFrame } from '../state/pair.js';
import type { Store } from '../state/state.js';
import { lengthOf } from '../state/tracked.js';
import type { Objects } from './clip/objects.js';
import type { ClipSegmenting } from './clip/segmenting.js';
import { importClasses } from './class-list.js';
import { report } from './failures.js';
import type { Frames } from './frames.js';
import type { Opening } from './opening.js';
import type { Shown } from './shown.js';

/** The parts that take what is opened. */
interface Parts {
  readonly opening: Opening;
  readonly frames: Frames;
  readonly projects: Projects;
  readonly clip: ClipSegmenting;
  readonly objects: Objects;
  readonly shown: Shown;
}

export class Open {
  readonly #store: Store;
  readonly #parts: Parts;

  constructor(store: Store, parts: Parts) {
    this.#store = store;
    this.#parts = parts;
  }

  /** Opens a sample and segments it. `ticket`: as `Opening.open` takes it. */
  sample(sample: Sample = SAMPLES[0], ticket?: number): Promise<void> {
    return this.#parts.frames.open(
      async () => this.#startOf(await openFolderOf(sample), sample.start),
      pairOf,
      () => void this.#begin(),
      ticket,
    );
  }

  /** Begins with the work that was kept last, or with a sample. */
  async begin(sample: Sample): Promise<void> {
    // What is opened while the work is being looked for is newer.
    const ticket = this.#parts.opening.ticket();
    const last = await this.#parts.projects.last();
    if (last === null || 'frames' in last) return this.sample(last ?? sample, ticket);
    await this.#frames(last, ticket);
    if (this.#store.get().pair.first === null) return this.sample(sample, ticket);
  }

  /**
   * Opens files. A video or several images are a clip, in the order of their names. One image waits for another one, with which it is a clip of
   * two. A project continues with its frames: those given with it, those on screen, or whenever they are opened. Masks are imported,
   * and lists of classes.
   */
  async files(files: Iterable<File> | Promise<Iterable<File>>): Promise<void> {
    // What is opened while these are still being looked at is newer.
    const ticket = this.#parts.opening.ticket();
    try {
      const given = [...(await files)];
      const maybeList = given.every(({ name }) => /\.(json|txt)$/i.test(name));
      const added = maybeList ? await importClasses(given, this.#store) : null;
      if (added !== null) return this.#store.say(added);
      const isOfClip = this.#store.get().tracked !== null;
      const maybe = isOfClip && given.some(({ name }) => /\.(json|png|txt|xml|zip)$/i.test(name));
      const areMasks = maybe && (await (await importing()).areMasks(given, this.#store.get()));
      await (areMasks ? this.masks(given) : this.#frames(given, ticket));
    } catch (error) {
      report(this.#store, error);
    }
  }

  /** Opens the two frames on screen as a clip: those of the camera. */
  async pair(): Promise<void> {
    const { first, second } = this.#store.get().pair;
    if (first !== null && second !== null) await this.files(await filesOf([first, second]));
  }

  /** Imports masks for the frames of the open clip. */
  async masks(files: readonly File[]): Promise<void> {
    try {
      const { objects, shown } = this.#parts;
      await (await importing()).importMasks(files, this.#store, objects, shown);
    } catch (error) {
      report(this.#store, error);
    }
  }

  #frames(files: readonly File[], ticket: number): Promise<void> {
    let opened: Header | null = null;
    let leftOut = '';
    let clip: Clip | null = null;
    let source: readonly File[] = [];
    return this.#parts.frames.open(
      async (signal) => {
        const { project, video, images: all } = selectOpenable(files);
        if (project !== null) opened = await this.#parts.projects.open(project);
        if (video !== null) {
          source = [video];
          return this.#startOf((clip = await openClip(video)));
        }
        const folders = foldersOf(all);
        const [likely, ...others] = likelyFrames(folders);
        const images = others.length > 0 ? await this.#chosen(folders, all, signal) : (likely?.images ?? []);
        if (images === null) return [];
        if (others.length === 0 && images.length < all.length) leftOut = strings.notices.leftOut(likely!.path, all.length - images.length);
        const [image] = images;
        if (image === undefined && project !== null) return [];
        if (image === undefined) throw new PageError('no-image', strings.notices.noFiles);
        const { pair, settings } = this.#store.get();
        const waiting = images.length === 1 && pair.second === null ? pair.first : null;
        if (images.length === 1 && waiting === null) return [await frameFromFile(image, image.name, settings.longestSide)];
        source = waiting === null ? images : await filesOf([waiting, image]);
        return this.#startOf((clip = await openFolder(source)));
      },
      (frames, pair) => (frames.length > 0 ? pairOf(frames) : pair),
      (found) => {
        if (opened !== null && found !== opened) this.#store.say(strings.projects.waiting(opened.name));
        else if (leftOut !== '') this.#store.say(leftOut);
        if (source.length > 0) this.#parts.projects.comeFrom(source);
        if (clip === null) return;
        if (clip.count > 2) void this.#checkSizes(clip); // of two frames the package says it
        void this.#begin();
      },
      ticket,
    );
  }

  /** Segments the clip that was opened, or goes on with it. */
  async #begin(): Promise<void> {
    const { living } = this.#parts.clip;
    await living?.opened.catch(() => undefined);
    const { automatic, tracked } = this.#store.get();
    if (!automatic || tracked === null || tracked.clip !== living?.clip || lengthOf(tracked.range) < 2) return;
    const { first, last } = tracked.range;
    if (!tracked.status.slice(first, last + 1).every(({ hasMasks }) => hasMasks) || tracked.status.length === 0) void this.#parts.clip.segment();
  }

  /** The images of the folder that the person chooses, or all; `null` if none. */
  async #chosen(folders: readonly ImageFolder[], images: readonly File[], signal: AbortSignal): Promise<readonly File[] | null> {
    if (signal.aborted) return null;
    const chosen = await new Promise<readonly File[] | null>((resolve) => {
      const answer = (files: readonly File[] | null): void => {
        this.#store.set({ question: null });
        resolve(files);
      };
      signal.addEventListener('abort', () => answer(null));
      this.#store.set({ question: { folders, images, answer } });
    });
    if (chosen === null && !signal.aborted) this.#parts.opening.stop();
    return chosen;
  }

  /** Tells of a frame that has another size than the clip, which ends where it is segmented. */
  async #checkSizes(clip: Clip): Promise<void> {
    const other = await clip.otherSize?.();
    if (!other || this.#store.get().timeline?.clip !== clip) return;
    this.#store.say(strings.errors.otherSize(clip.nameOf(other.index), other, clip), 'frame-size-mismatch');
  }

  /** The frames that a clip begins with. */
  async #startOf(clip: Clip, at = 0): Promise<LoadedFrame[]> {
    try {
      return await this.#parts.frames.readPair(clip, at);
    } catch (error) {
      clip.close();
      throw error;
    }
  }

}

function importing(): Promise<typeof import('./clip/importing.js')> {
  return loaded(() => import('./clip/importing.js'));
}

/** Opens a sample as the folder that it is. */
async function openFolderOf(sample: Sample): Promise<Clip> {
  const images = await Promise.all(sample.frames.map(fetchImage));
  return openFolder(images.map((image) => withPath(image, `${sample.id}/${image.name}`)), sample);
}

function pairOf([first, second]: readonly LoadedFrame[]): FramePair {
  return { first: first ?? null, second: second ?? null };
}
