// <veronese-segmenter>: two frames or a clip in, masks over the frames out, as a custom element and a control of forms. Importing this
// file registers nothing.

import type { ClipFrames, FrameSource, VeroneseSegmenterEvents, VeroneseSegmenterMessages } from '../../types/element-class.js';
import type { Clip, ClipTracks, Pixels, Segmentation, WasmSource, WorkerLike } from '../../types/index.js';
import { groupLabels, maskOf } from '../calls/labels.js';
import { UNLABELLED } from '../common/checks.js';
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
  readonly #listeners: ConstructorParameters<typeof ElementClip>[3] = {
    show: (frame) => this.#paintFrame(frame),
    frame: (frame) => this.#tell('frame', frame),
    masks: () => this.#carry(),
    tracks: (tracks) => this.#end('tracks', tracks),
    progress: (progress) => this.#tell('progress', progress),
    change: () => this.#validate(),
    fail: (thrown) => this.#fail(veroneseError(thrown)),
  };
  /** What a form gets. */
  #files: File[] = [];
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
    this.#leaveClip();
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

  /** The clip that is open, to annotate and to read; it is undefined for two frames and for a stream. */
  get clip(): Clip | undefined {
    return this.#clip?.clip;
  }

  /** The objects of the frames that are done. */
  tracks(): ClipTracks | undefined {
    return this.#clip?.tracks;
  }

  /**
   * Segments what is given, with the attributes as they are. Made by itself when the element is connected and when an attribute
   * changes; a new call ends the one before, which rejects with code `cancelled`.
   */
  segment(): Promise<Segmentation | ClipTracks> {
    return this.#run<Segmentation | ClipTracks>((signal) => (this.#isClip() ? this.#segmentClip(signal) : this.#segmentPair(signal)));
  }

  /** Cancels all that has not taken effect; the last result stays, as do the frames of a clip that are done. */
  abort(): void {
    this.#stop();
    this.#clip?.clip?.cancel();
  }

  #stop(): void {
    const request = this.#request;
    this.#request = undefined;
    if (request === undefined) return;
    request.abort();
    this.#validate();
    this.#carryLater();
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
    this.#leaveClip();
    this.#segmenter?.close();
    this.#segmenter = undefined;
  }

  attributeChangedCallback(name: string, before: string | null, now: string | null): void {
    if (before === now) return;
    if (name === 'first' || name === 'second') delete this.#given[name];
    if (name === 'src') this.#given = {};
    if (name === 'required') this.#validate();
    else if (name !== 'name' && name !== 'grouped') this.#plan();
    else {
      if (name === 'name') this.#submit();
      else if (this.#result) this.#paintPair(this.#result);
      this.#carryLater();
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
    if (this.#clip) this.#clip.timeline.disabled = disabled;
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
    this.#stop();
    const request = new AbortController();
    const { signal } = request;
    this.#request = request;
    this.#failure = undefined;
    this.#validate();
    const aborted = new Promise<never>((_, reject) => signal.addEventListener('abort', reject));
    try {
      return await Promise.race([work(signal), aborted]);
    } catch (thrown) {
      const error = signal.aborted ? new VeroneseError('cancelled', 'the call was cancelled') : veroneseError(thrown);
      if (this.#request === request) {
        this.#request = undefined;
        // A caller can cancel the step of a clip, too.
        if (error.code === 'cancelled') this.#validate();
        else this.#fail(error);
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
    const result = await segmenter.segmentPair(first, second, {
      ...this.#options(signal),
      onProgress: (progress) => this.#tell('progress', progress),
    });
    signal.throwIfAborted();
    this.#result = result;
    this.#paintPair(result);
    await this.#carry();
    signal.throwIfAborted();
    this.#request = undefined;
    this.#end('result', result);
    return result;
  }

  /** The same frames stay the same clip, with its annotations and steps. */
  async #segmentClip(signal: AbortSignal): Promise<ClipTracks> {
    const pool = this.#worker();
    const given = this.#given.frames ?? this.src;
    const { ElementClip } = await import('./later.js');
    signal.throwIfAborted();
    const opened = this.#clip?.given === given && this.#clip.clip ? this.#clip : undefined;
    const clip = opened ?? new ElementClip(given, this.ownerDocument.baseURI, () => this.#texts, this.#listeners);
    if (!opened) this.#showClip(clip);
    this.#view.stage.append(clip.progress);
    try {
      if (!opened) await clip.open(pool);
      signal.throwIfAborted();
      const tracks = await clip.segment(pool, this.#options(signal));
      signal.throwIfAborted();
      this.#request = undefined;
      this.#end('tracks', tracks);
      return tracks;
    } catch (thrown) {
      // Another attempt begins anew, unless something would be lost.
      if (!signal.aborted && this.#clip === clip && clip.length === 0) this.#leaveClip();
      throw thrown;
    }
  }

  #showClip(clip: ElementClip): void {
    this.#leaveClip();
    this.#result = undefined;
    this.#clip = clip;
    this.#view.stage.after(...clip.timeline.parts);
    clip.timeline.disabled = this.matches(':disabled');
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
    return { ...optionsOf((name) => this.getAttribute(name)), signal };
  }

  async #pixels(slot: 'first' | 'second', signal: AbortSignal): Promise<Pixels> {
    const source = this.#given[slot] ?? this.getAttribute(slot) ?? '';
    if (source instanceof VeroneseError) throw source;
    return source instanceof Promise ? source : pixelsOf(`the ${slot} frame`, source, this.#place(signal));
  }

  #leaveClip(): void {
    if (this.#clip === undefined) return;
    this.#clip.close();
    this.#clip = undefined;
    this.#shown = undefined;
    this.#validate();
    this.#carryLater();
  }

  #paintPair(result: Segmentation): void {
    const { width, height, count } = result;
    const labels = this.labels();
    if (labels) this.#view.paint(this, labels, width, height, this.#texts.pair(count));
  }

  #paintFrame({ index, of, picture, labels }: ShownFrame): void {
    const { width, height } = picture;
    this.#shown = labels;
    this.#view.draw(picture);
    if (!labels) return;
    const objects = new Set(labels.filter((label) => label !== 0 && label !== UNLABELLED)).size;
    this.#view.paint(this, labels, width, height, this.#texts.frame(index + 1, of, objects));
    this.#tell('show', { index, width, height, labels });
  }

  /** Hands the masks to the form, as files. */
  async #carry(): Promise<void> {
    const turn = ++this.#carries;
    const files = this.name === '' ? [] : await this.#masks();
    // A later call knows better.
    if (turn !== this.#carries) return;
    this.#files = files;
    this.#submit();
  }

  /** Where nobody waits: labels that cannot be had have an event of their own. */
  #carryLater(): void {
    this.#carry().catch(() => undefined);
  }

  async #masks(): Promise<File[]> {
    if (this.#clip) return this.#clip.files();
    const [result, labels] = [this.#result, this.labels()];
    if (!result || !labels) return [];
    const { fileOf, packed } = await import('./later.js');
    return [fileOf(await packed(labels, result.width, result.height), 'labels.png')];
  }

  #submit(): void {
    const value = new FormData();
    if (this.name !== '') for (const file of this.#files) value.append(this.name, file);
    this.#internals.setFormValue(value);
  }

  #validate(): void {
    const busy = this.#request !== undefined || this.#clip?.isBusy === true;
    if (!busy) this.#clip?.progress.remove();
    const missing = this.required && this.labels() === undefined;
    const failure = this.#failure && this.#texts.error(this.#failure);
    const sentence = busy ? this.#texts.busy : (failure ?? (missing ? this.#texts.missing : ''));
    const flags = missing && !busy && !this.#failure ? { valueMissing: true } : { customError: sentence !== '' };
    this.#internals.ariaBusy = String(busy);
    this.#internals.setValidity(flags, sentence, this.#view.objects);
  }

  /** A request or a step has ended well: the validity changes before the event. */
  #end(type: 'result' | 'tracks', result: Segmentation | ClipTracks): void {
    this.#view.status.textContent = (result.notes ?? []).map(({ message }) => message).join('; ');
    this.#validate();
    this.#tell(type, result);
  }

  #fail(error: VeroneseError): void {
    this.#failure = error;
    this.#view.status.textContent = this.#texts.error(error);
    this.#validate();
    this.#carryLater();
    this.#tell('error', error);
  }

  #tell(type: keyof VeroneseSegmenterEvents, detail: unknown): void {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
