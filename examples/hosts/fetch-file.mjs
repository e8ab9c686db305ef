// A file by an address that somebody else chose: from the servers that were named alone, and the token for one of them.

import { Refusal } from './http.mjs';

/** Largest file, bytes; how long it may take, milliseconds: Label Studio itself gives up after 100 s; and how often it may be elsewhere. */
const LARGEST = 64 * 1024 * 1024;
const PATIENCE = 30_000;
const REDIRECTS = 5;

/**
 * A function that fetches files. `home` is the origin that relative addresses belong to and the only one that sees a token; the others are
 * in `allow`.
 */
export function createFetch({ home, allow = [] } = {}) {
  const named = new Set([home, ...allow].filter(Boolean).map(originOf));

  return async function fetchFile(address, { token, signal }) {
    const limit = AbortSignal.any([signal, AbortSignal.timeout(PATIENCE)]);
    try {
      const response = await answered(address, token, limit);
      const [pieces, size] = [[], { bytes: 0 }];
      for await (const piece of response.body) {
        size.bytes += piece.length;
        if (size.bytes > LARGEST) throw refused(address, `has more than ${LARGEST} bytes`, 'unreadable-file');
        pieces.push(piece);
      }
      return Buffer.concat(pieces);
    } catch (error) {
      signal.throwIfAborted();
      throw error instanceof Refusal ? error : refused(address, `cannot be fetched: ${error.cause?.message ?? error.message}`);
    }
  };

  async function answered(address, token, signal) {
    if (/^data:/i.test(address)) return fetch(address);
    let url = checked(address, home);
    // A stranger who redirects back home does not get to ask there in our name.
    let trusted = true;
    for (let hop = 0; hop <= REDIRECTS; hop++) {
      trusted &&= url.origin === home;
      // Label Studio answers 406 to who wants images alone.
      const headers = { Accept: '*/*', ...(trusted && token && { Authorization: await authorization(token, signal) }) };
      const response = await fetch(url, { headers, redirect: 'manual', signal });
      if (response.ok) return response;
      await response.body?.cancel();
      const location = response.headers.get('location');
      const hint = trusted && [401, 403].includes(response.status) ? ': see LABEL_STUDIO_API_KEY in label-studio.md' : '';
      if (response.status < 300 || response.status > 399 || location === null) throw refused(address, `answered ${response.status}${hint}`);
      url = checked(location, url);
    }
    throw refused(address, `is redirected more than ${REDIRECTS} times`);
  }

  /** The address, if it is one of a server that was named. */
  function checked(address, base) {
    if (!URL.canParse(address, base))
      throw refused(address, 'is no address; set LABEL_STUDIO_URL for files of Label Studio', 'invalid-input');
    const url = new URL(address, base);
    if (named.has(url.origin) && !url.username && !url.password) return url;
    throw refused(url.origin, `is not allowed: start the server with --allow ${url.origin}`, 'address-refused');
  }

  /** Of a personal access token Label Studio makes one that opens its files for some minutes. Legacy tokens open them as they are. */
  async function authorization(token, signal) {
    if (!/^[^.]+\.[^.]+\.[^.]+$/.test(token)) return `Token ${token}`;
    const headers = { 'Content-Type': 'application/json' };
    const response = await fetch(new URL('/api/token/refresh', home), {
      method: 'POST',
      headers,
      body: JSON.stringify({ refresh: token }),
      redirect: 'error',
      signal,
    });
    return `Bearer ${(await response.json()).access}`;
  }
}

/** The origin of an address that the one who runs the server wrote. */
export function originOf(text) {
  const url = URL.canParse(text) ? new URL(text) : undefined;
  if (!url || !/^https?:$/.test(url.protocol)) throw new Error(`'${text}' is not an address of http or https`);
  return url.origin;
}

function refused(address, what, code = 'file-not-found') {
  return new Refusal(422, code, `${String(address).slice(0, 200)} ${what}`);
}
