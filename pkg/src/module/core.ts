// One instance of the WebAssembly module: loaded once, replaced after a panic.

import type { WasmSource } from '../../types/index.js';
import { isFailure, VeroneseError, veroneseError } from '../common/errors.js';
import { compile, loadFailed, type Read } from './loading.js';

/** The part of the generated glue that every build has. */
export interface Glue {
  /** Makes the instance, unless there is one. */
  instantiate(module: WebAssembly.Module): Promise<unknown>;
  /** Lets go of the instance: the next initialisation makes a new one. */
  forgetInstance(): void;
}

/** Glue that has an instance to call. Entries that are loaded together share it. */
const live = new WeakSet<Glue>();

export class Core<G extends Glue> {
  readonly #glue: G;
  readonly #read: Read;
  readonly #place: URL | undefined;
  #module: Promise<WebAssembly.Module> | undefined;
  #instance: Promise<unknown> | undefined;

  /** `place`: where the module lies by default. */
  constructor(glue: G, read: Read, place?: URL) {
    this.#glue = glue;
    this.#read = read;
    this.#place = place;
  }

  /** Compiles once. After a failure the next call tries again. */
  module(source?: WasmSource | Promise<WasmSource>): Promise<WebAssembly.Module> {
    if (!this.#module) {
      const from = source ?? this.#place;
      const module = from ? compile(from, this.#read) : Promise.reject(loadFailed('no source was given'));
      this.#module = module;
      module.catch(() => {
        if (this.#module === module) this.#module = undefined;
      });
    }
    return this.#module;
  }

  async init(source?: WasmSource | Promise<WasmSource>): Promise<void> {
    this.#instance ??= this.#instantiate(source);
    const instance = this.#instance;
    try {
      await instance;
    } catch (thrown) {
      if (this.#instance === instance) this.#instance = undefined;
      throw thrown;
    }
  }

  async #instantiate(source?: WasmSource | Promise<WasmSource>): Promise<void> {
    const module = await this.module(source);
    try {
      await this.#glue.instantiate(module);
      live.add(this.#glue);
    } catch (thrown) {
      // A module, but not ours: do not keep it.
      this.#glue.forgetInstance();
      this.#module = undefined;
      throw loadFailed(thrown instanceof Error ? thrown.message : String(thrown), thrown);
    }
  }

  /**
   * Runs `work` on the instance. An error that Rust returned leaves the instance as it was; anything else (a panic, a trap,
   * an exception that crossed Rust frames) may not have, so the next call gets a fresh one.
   */
  async call<T>(work: (glue: G) => T): Promise<T> {
    let awaited: Promise<unknown> | undefined;
    do {
      // Another call, perhaps of another entry with the same glue, let go of the instance just before our turn.
      if (awaited && this.#instance === awaited) this.#instance = undefined;
      await this.init();
      awaited = this.#instance;
    } while (!live.has(this.#glue));
    try {
      return work(this.#glue);
    } catch (thrown) {
      const ordinary = isFailure(thrown) && !(thrown instanceof VeroneseError) && thrown.code !== 'internal';
      if (!ordinary) {
        this.#glue.forgetInstance();
        live.delete(this.#glue);
        this.#instance = undefined;
      }
      throw veroneseError(thrown);
    }
  }
}
