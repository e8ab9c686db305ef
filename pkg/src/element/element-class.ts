// <veronese-segmenter>: two frames or a clip in, masks over the frames out, as a custom element and a control of forms. Importing this
// file registers nothing.

import type { ClipFrames, ElementPrompt, FrameSource, VeroneseSegmenterEvents, VeroneseSegmenterMessages } from '../../types/element-class.js';
import type { ClipCorrection, ClipFrame, ClipProgress, ClipPrompt, ClipTracks, Pixels, Progress, Segmentation, WasmSource, WorkerLike } from '../../types/index.js';
import { groupLabels, maskOf } from '../calls/labels.js';
import { isObject, UNLABELLED } from '../common/checks.js';
import { VeroneseError, veroneseError } from '../common/errors.js';
import { SegmenterPool } from '../entries/web.js';
import type { ElementClip, ShownFrame } from './clip.js';
import { ENGLISH } from './messages.js';
import { optionsOf } from './options.js';
import { type Kept, kept, type Place, pixelsOf } from './sources.js';
import { View } from './view.js';

/** Where there are no elements (Node, a worker), the class can still be imported. */
const Base = globalThis.HTMLElement ?? class {};

const PROPERTIES = ['messages', 'frames', 'currentFrame', 'selected', 'src', 'name', 'disabled', 'required'] as const;

export class VeroneseSegmenterElement extends Base {
  /** Makes the workers, and is the module's source; undefined for the files beside this one. */
  static worker: (() => WorkerLike) | undefined;
  static source: WasmSource | Promise<WasmSource> | undefined;
  static Pool: typeof SegmenterPool = SegmenterPool;
  static readonly formAssociated = true;
  static readonly observedAttributes = ['first', 'second', 'src', 'motions', 'quality', 'subject', 'grouped', 'name', 'required'];

  readonly #internals: ElementInternals;
  readonly #view: View;
  /** Set by a script, instead of the attributes. */
  #given: { first?: Kept; second?: Kept; frames?: ClipFrames } = {};
  #segmenter: InstanceType<typeof SegmenterPool> | undefined;
  #request: AbortController | undefined;
  #result: Segmentation | undefined;
  #clip: ElementClip | undefined;
  /** The labels of the clip's frame that is shown. */
  #shown: Uint8Array | undefined;
  #failure: VeroneseError | undefined;
  /** Objects of the clip that no correction changes. */
  #locked: readonly number[] | undefined;
  /** Frames of the clip that are right. */
  #accepted: readonly number[] | undefined;
  /** Settled when the corrections so far have spread. */
  #corrected: Promise<unknown> = Promise.resolve();
  #carries = 0;
  #planned = false;
  #messages: Partial<VeroneseSegmenterMessages> = {};

  constructor() {
    super();
    this.#internals = this.attachInternals();
    this.#internals.role = 'group';
    this.#view = new View(this.attachShadow({ mode: 'open', delegatesFocus: true }), () => this.#texts, {
      select: (object) => this.#tell('select', object),
      step: (frames) => (this.currentFrame += frames),
      zoom: async (...parts) => new (await import('./later.js')).Zoom(...parts),
    });
    for (const name of PROPERTIES) {
      // Set when this was not yet an element of ours.
      if (!Object.hasOwn(this, name)) continue;
      const value = this[name];
      Reflect.deleteProperty(this, name);
      Object.assign(this, { [name]: value });
    }
  }

  /** The last result of two frames, as {@link Segmenter.segmentPair} gave it. */
  get result(): Segmentation | undefined {
    return this.#result;
  }

  /** Sets both frames at once, also from pixels, which attributes cannot name: these and bitmaps are copied at once. */
  setFrames(first: FrameSource, second: FrameSource): Promise<Segmentation> {
    this.#given = { first: kept('the first frame', first), second: kept('the second frame', second) };
    return this.#run((signal) => this.#segmentPair(signal));
  }

  get frames(): ClipFrames | undefined {
    return this.#given.frames;
  }

  /** A clip, instead of what attributes name; it is segmented at once, or when the element is connected. */
  set frames(frames: ClipFrames | undefined | null) {
    this.abort();
    this.#given = frames === undefined || frames === null ? {} : { frames };
    this.#plan();
  }

  get messages(): Partial<VeroneseSegmenterMessages> {
    return this.#messages;
  }

  /** Shows at once what there is in these words. */
  set messages(messages: Partial<VeroneseSegmenterMessages> | undefined | null) {
    this.#messages = { ...messages };
    this.#view.name();
    this.#clip?.name();
    if (this.#clip) this.#clip.show(this.currentFrame);
    else if (this.#result) this.#paintPair(this.#result);
    if (this.#failure) this.#view.status.textContent = this.#texts.error(this.#failure);
    this.#validate();
  }

  get #texts(): VeroneseSegmenterMessages {
    return { ...ENGLISH, ...this.#messages };
  }

  /** Number of the clip's frames that are done. */
  get frameCount(): number {
    return this.#clip?.length ?? 0;
  }

  /** Index of the frame of a clip that is shown. */
  get currentFrame(): number {
    return this.#clip?.current ?? 0;
  }

  set currentFrame(index: number) {
    if (this.frameCount > 0 && index !== this.currentFrame) this.#clip?.show(index);
  }

  /** The chosen object; null for none. */
  get selected(): number | null {
    return this.#view.selected;
  }

  set selected(object: number | null) {
    this.#view.selected = object;
  }

  /** The objects of the frames that are done. */
  tracks(): ClipTracks | undefined {
    return this.#clip?.tracks();
  }

  /**
   * Segments what is given, with the attributes as they are. Made by itself when the element is connected and when an attribute
   * changes; a new call ends the one before, which rejects with code `cancelled`.
   */
  segment(): Promise<Segmentation | ClipTracks> {
    return this.#run<Segmentation | ClipTracks>((signal) => (this.#isClip() ? this.#segmentClip(signal) : this.#segmentPair(signal)));
  }

  /**
   * Corrects a frame of a clip whose frames are all done, when earlier corrections have spread; returns the indices of the frames that
   * change.
   */
  async correct(frame: number, said: Uint8Array | ElementPrompt, { propagate, object }: Pick<ClipCorrection, 'propagate' | 'object'> = {}): Promise<number[]> {
    const own = said instanceof Uint8Array || !isObject(said) ? { labels: said instanceof Uint8Array ? said.slice() : said, object } : structuredClone(said);
    const correction: ClipCorrection | ClipPrompt = { ...own, frame, propagate };
    if (!this.#tell('veronese-correction', correction, true)) return [];
    const turn = this.#corrected.then(() => this.#correct(correction));
    this.#corrected = turn.catch(() => undefined);
    return turn;
  }

  /** No later correction changes these objects of the clip. */
  lock(objects: readonly number[]): void {
    this.#locked = [...objects];
  }

  /** Later corrections of other frames change nothing in these frames of the clip. */
  accept(frames: readonly number[]): void {
    this.#accepted = [...frames];
  }

  /** Stops at once; the last result stays, as do the frames of a clip that are done. */
  abort(): void {
    const request = this.#request;
    this.#request = undefined;
    if (request === undefined) return;
    request.abort();
    this.#validate();
    void this.#carry();
  }

  /** One number per pixel of what is shown: labels, or groups where the element is `grouped` or shows the main subject; 255 is unlabelled. */
  labels(): Uint8Array | undefined {
    if (this.#clip) return this.#shown;
    if (this.#result === undefined) return undefined;
    return this.hasAttribute('grouped') || this.#result.settings.subject ? groupLabels(this.#result) : this.#result.labels;
  }

  /** 255 where the label (or group) is, 0 elsewhere. */
  mask(wanted: number): Uint8Array | undefined {
    const labels = this.labels();
    return labels && maskOf(labels, wanted);
  }

  get form(): HTMLFormElement | null {
    return this.#internals.form;
  }

  get validity(): ValidityState {
    return this.#internals.validity;
  }

  get validationMessage(): string {
    return this.#internals.validationMessage;
  }

  get willValidate(): boolean {
    return this.#internals.willValidate;
  }

  checkValidity(): boolean {
    return this.#internals.checkValidity();
  }

  reportValidity(): boolean {
    return this.#internals.reportValidity();
  }

  get src(): string {
    return this.getAttribute('src') ?? '';
  }

  set src(address: string) {
    this.setAttribute('src', address);
  }

  get name(): string {
    return this.getAttribute('name') ?? '';
  }

  set name(name: string) {
    this.setAttribute('name', name);
  }

  get disabled(): boolean {
    return this.hasAttribute('disabled');
  }

  set disabled(disabled: boolean) {
    this.toggleAttribute('disabled', disabled);
  }

  get required(): boolean {
    return this.hasAttribute('required');
  }

  set required(required: boolean) {
    this.toggleAttribute('required', required);
  }

  connectedCallback(): void {
    this.#validate();
    this.#plan();
  }

  disconnectedCallback(): void {
    this.abort();
    this.#segmenter?.close();
    this.#segmenter = undefined;
  }

  attributeChangedCallback(name: string, before: string | null, now: string | null): void {
    if (before === now) return;
    if (name === 'first' || name === 'second') delete this.#given[name];
    if (name === 'src') this.#given = {};
    if (name === 'required') this.#validate();
    else if (name === 'name') void this.#carry();
    else if (name !== 'grouped') this.#plan();
    else if (this.#result && !this.#clip) {
      this.#paintPair(this.#result);
      void this.#carry();
    }
  }

  /** Back to how it was before a person touched it. */
  formResetCallback(): void {
    this.currentFrame = 0;
    this.selected = null;
  }

  /** By the attribute, or by a fieldset around the element. */
  formDisabledCallback(disabled: boolean): void {
    this.#view.disabled = disabled;
    if (this.#clip) this.#clip.disabled = disabled;
  }

  /** Several attributes that change together are one request. */
  #plan(): void {
    const given = this.#isClip() || (this.#has('first') && this.#has('second'));
    if (this.#planned || !this.isConnected || !given) return;
    this.#planned = true;
    queueMicrotask(() => {
      if (!this.#planned) return;
      this.#planned = false;
      if (this.isConnected) this.segment().catch(() => undefined); // the event has the error
    });
  }

  #has(slot: 'first' | 'second'): boolean {
    return this.#given[slot] !== undefined || Boolean(this.getAttribute(slot));
  }

  #isClip(): boolean {
    return this.#given.frames !== undefined || (this.#given.first === undefined && this.src !== '');
  }

  #place(signal?: AbortSignal): Place {
    return { base: this.ownerDocument.baseURI, signal };
  }

  /** Makes one request at a time, and tells how it ended. */
  async #run<T>(work: (signal: AbortSignal) => Promise<T>): Promise<T> {
    this.#planned = false;
    this.abort();
    const request = new AbortController();
    const { signal } = request;
    this.#request = request;
    this.#failure = undefined;
    this.#validate();
    try {
      return await work(signal);
    } catch (thrown) {
      const error = signal.aborted ? new VeroneseError('cancelled', 'the call was cancelled') : veroneseError(thrown);
      if (this.#request === request) {
        this.#request = undefined;
        this.#fail(error);
      }
      throw error;
    }
  }

  async #segmentPair(signal: AbortSignal): Promise<Segmentation> {
    const segmenter = this.#worker();
    const loading = [this.#pixels('first', signal), this.#pixels('second', signal)] as const;
    // Where neither can be read the first is named, whichever fails earlier.
    await Promise.allSettled(loading);
    const [first, second] = await Promise.all(loading);
    signal.throwIfAborted();
    this.#leaveClip();
    this.#view.draw(first);
    const result = await segmenter.segmentPair(first, second, this.#options(signal));
    signal.throwIfAborted();
    this.#result = result;
    this.#paintPair(result);
    await this.#carry();
    signal.throwIfAborted();
    this.#end(result);
    this.#tell('result', result);
    return result;
  }

  async #segmentClip(signal: AbortSignal): Promise<ClipTracks> {
    const segmenter = this.#worker();
    const { ElementClip } = await import('./later.js');
    signal.throwIfAborted();
    this.#leaveClip();
    this.#result = undefined;
    const clip = new ElementClip(() => this.#texts, { show: (frame) => this.#paintFrame(frame), fail: (thrown) => this.#fail(veroneseError(thrown)) });
    this.#clip = clip;
    this.#view.stage.append(clip.progress);
    this.#view.stage.after(clip.timeline, clip.controls);
    clip.disabled = this.matches(':disabled');
    try {
      await clip.open(this.#given.frames ?? this.src, this.#place(signal));
      const poster = await clip.poster();
      signal.throwIfAborted();
      if (poster) this.#view.draw(poster);
      for await (const frame of clip.segment((frames) => segmenter.segmentClip(frames, this.#options(signal)))) {
        this.#tell('frame', frame);
        // Frames that come once are followed, unless a person looks at an earlier one.
        if (frame.index === 0 || (clip.streams && clip.current === frame.index - 1)) clip.show(frame.index);
      }
      await clip.shown();
      await this.#carry();
      signal.throwIfAborted();
      const tracks = clip.tracks();
      this.#end(tracks);
      this.#tell('tracks', tracks);
      return tracks;
    } finally {
      clip.progress.remove();
    }
  }

  async #correct(correction: ClipCorrection | ClipPrompt): Promise<number[]> {
    const clip = this.#clip;
    if (!clip?.takesCorrections || this.#request !== undefined) {
      throw new VeroneseError('invalid-input', 'corrections are for clips whose frames are all done and can be read again');
    }
    const request = new AbortController();
    const { signal } = request;
    this.#request = request;
    this.#validate();
    const changed: number[] = [];
    try {
      const options = { ...this.#options(signal), corrections: [correction], locked: this.#locked, accepted: this.#accepted, changesOnly: true };
      const onChange = async (index: number, segmented: () => Promise<ClipFrame>) => {
        if (index === clip.current) await clip.preview(await segmented());
      };
      for await (const frame of clip.correct((frames, state) => this.#worker().segmentClip(frames, { ...options, state, onChange }))) {
        changed.push(frame.index);
        this.#tell('frame', frame);
      }
      clip.show(clip.current);
      await clip.shown();
      await this.#carry();
      signal.throwIfAborted();
      const tracks = clip.tracks();
      this.#end(tracks);
      this.#tell('tracks', tracks);
      return changed;
    } catch (thrown) {
      if (this.#clip === clip) clip.show(clip.current);
      if (this.#request === request) {
        this.#request = undefined;
        this.#validate();
      }
      throw signal.aborted ? new VeroneseError('cancelled', 'the call was cancelled') : veroneseError(thrown);
    }
  }

  /** Asked for before the frames are decoded: a new worker warms up meanwhile. */
  #worker(): InstanceType<typeof SegmenterPool> {
    if (this.#segmenter === undefined) {
      // Of more than two processors one is left for the page; more than eight workers are not worth their memory.
      const processors = navigator.hardwareConcurrency || 1;
      const { Pool, worker, source } = this.constructor as typeof VeroneseSegmenterElement;
      this.#segmenter = new Pool({ jobs: Math.min(processors > 2 ? processors - 1 : processors, 8), worker, source });
      this.#segmenter.warmUp().catch(() => undefined); // the call that needs the worker gives the error
    }
    return this.#segmenter;
  }

  #options(signal: AbortSignal) {
    const onProgress = (progress: Progress | ClipProgress) => {
      if ('frame' in progress) this.#clip?.report(progress);
      this.#tell('progress', progress);
    };
    return { ...optionsOf((name) => this.getAttribute(name)), signal, onProgress };
  }

  async #pixels(slot: 'first' | 'second', signal: AbortSignal): Promise<Pixels> {
    const source = this.#given[slot] ?? this.getAttribute(slot) ?? '';
    if (source instanceof VeroneseError) throw source;
    return source instanceof Promise ? source : pixelsOf(`the ${slot} frame`, source, this.#place(signal));
  }

  #leaveClip(): void {
    this.#clip?.close();
    this.#clip = undefined;
    this.#locked = undefined;
    this.#accepted = undefined;
    this.#shown = undefined;
  }

  #paintPair(result: Segmentation): void {
    const { width, height, count } = result;
    const labels = this.labels();
    if (labels) this.#view.paint(this, labels, width, height, this.#texts.pair(count));
  }

  #paintFrame({ index, of, picture, labels }: ShownFrame): void {
    const { width, height } = picture;
    const objects = new Set(labels.filter((label) => label !== 0 && label !== UNLABELLED)).size;
    this.#shown = labels;
    this.#view.draw(picture);
    this.#view.paint(this, labels, width, height, this.#texts.frame(index + 1, of, objects));
    this.#tell('show', { index, width, height, labels });
  }

  /** Hands the masks to the form, as files. */
  async #carry(): Promise<void> {
    const turn = ++this.#carries;
    const { name } = this;
    const clip = this.#clip;
    const labels = this.labels();
    const value = new FormData();
    if (name !== '' && clip) for (const file of clip.files()) value.append(name, file);
    if (name !== '' && !clip && labels && this.#result) {
      const { fileOf, packed } = await import('./later.js');
      const { width, height } = this.#result;
      value.append(name, fileOf(await packed(labels, width, height), 'labels.png'));
    }
    // A later call knows better.
    if (turn === this.#carries) this.#internals.setFormValue(value);
  }

  #validate(): void {
    const busy = this.#request !== undefined;
    const missing = this.required && this.labels() === undefined;
    const failure = this.#failure && this.#texts.error(this.#failure);
    const sentence = busy ? this.#texts.busy : (failure ?? (missing ? this.#texts.missing : ''));
    const flags = missing && !busy && !this.#failure ? { valueMissing: true } : { customError: sentence !== '' };
    this.#internals.ariaBusy = String(busy);
    this.#internals.setValidity(flags, sentence, this.#view.objects);
  }

  /** A request has ended well: the validity changes before the event. */
  #end({ notes = [] }: Segmentation | ClipTracks): void {
    this.#request = undefined;
    this.#view.status.textContent = notes.map(({ message }) => message).join('; ');
    this.#validate();
  }

  #fail(error: VeroneseError): void {
    this.#failure = error;
    this.#view.status.textContent = this.#texts.error(error);
    this.#validate();
    void this.#carry();
    this.#tell('error', error);
  }

  /** Returns whether it goes on: a listener can prevent what is `cancelable`. */
  #tell(type: keyof VeroneseSegmenterEvents, detail: unknown, cancelable = false): boolean {
    return this.dispatchEvent(new CustomEvent(type, { detail, cancelable }));
  }
}
