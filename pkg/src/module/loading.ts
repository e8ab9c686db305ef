// From whatever the caller has to a compiled WebAssembly module.

import type { WasmSource } from '../../types/index.js';
import { VeroneseError } from '../common/errors.js';

/** Fetches or reads what a URL or path names: the one thing in which browser and Node differ. */
export type Read = (place: URL | string) => Promise<Response | ArrayBuffer | ArrayBufferView>;

export async function compile(source: WasmSource | Promise<WasmSource>, read: Read): Promise<WebAssembly.Module> {
  try {
    const given = await source;
    if (given instanceof WebAssembly.Module) return given;
    const isPlace = typeof given === 'string' || given instanceof URL;
    const bytes = await bytesOf(isPlace ? await read(given).catch((thrown: Error) => notReached(String(given), thrown)) : given);
    if (!isModule(bytes)) throw noModule(bytes, isPlace ? String(given) : (given as Partial<Response>).url);
    return await WebAssembly.compile(bytes);
  } catch (thrown) {
    if (thrown instanceof VeroneseError) throw thrown;
    const reason = thrown instanceof Error ? thrown.message : String(thrown);
    throw loadFailed(reason, thrown);
  }
}

const REMEDY = '; give its URL to init(), or import veronese/inline (of the element: source, veronese/element/inline)';

function notReached(place: string, thrown: Error): never {
  throw loadFailed(`${place} cannot be reached (${thrown.message})${REMEDY}`, thrown);
}

export function loadFailed(reason: string, cause?: unknown): VeroneseError {
  return new VeroneseError('wasm-load-failed', `the WebAssembly module cannot be loaded: ${reason}`, { cause });
}

async function bytesOf(source: Response | ArrayBuffer | ArrayBufferView): Promise<Uint8Array<ArrayBuffer>> {
  if (ArrayBuffer.isView(source)) return new Uint8Array(source.buffer as ArrayBuffer, source.byteOffset, source.byteLength);
  if (source instanceof ArrayBuffer) return new Uint8Array(source);
  // Last, because in Node the name alone loads all that fetches, which takes as long as compiling the module.
  if (source instanceof Response) {
    if (!source.ok) throw loadFailed(`${source.url || 'the server'} answered ${`${source.status} ${source.statusText}`.trim()}${REMEDY}`);
    return new Uint8Array(await source.arrayBuffer());
  }
  throw loadFailed('the source must be a URL, string, Response, BufferSource or WebAssembly.Module');
}

function isModule(bytes: Uint8Array): boolean {
  return bytes[0] === 0 && bytes[1] === 0x61 && bytes[2] === 0x73 && bytes[3] === 0x6d;
}

/** A server that answers with a page instead of the file is the usual failure: say so. */
function noModule(bytes: Uint8Array, place: string | undefined): VeroneseError {
  const where = place ? `${place} ` : 'the source ';
  if (bytes[0] === 0x3c && bytes[1] === 0x21) {
    return loadFailed(
      `${where}is an HTML page; the server sends its page where a module of the package should be. Under Vite 7 put ` +
        "optimizeDeps: { exclude: ['veronese'] } into the configuration, or pass the file's URL to init() or initPoints()",
    );
  }
  return loadFailed(`${where}is no WebAssembly module`);
}
