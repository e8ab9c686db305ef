// A file by an address that somebody else chose: no way into the network that this server stands in, and no way out for its token.

import { lookup as systemLookup } from 'node:dns';
import { request as plainRequest } from 'node:http';
import { request as secureRequest } from 'node:https';
import { isIP } from 'node:net';
import ipaddr from 'ipaddr.js';
import { Refusal } from './http.mjs';

/** Largest file, bytes; how long it may take, milliseconds: Label Studio itself gives up after 100 s; and how often it may be elsewhere. */
const LARGEST = 64 * 1024 * 1024;
const PATIENCE = 30_000;
const REDIRECTS = 5;
/** The content types that a file of a kind may have. */
const TYPES = {
  image: /^(image\/|[a-z]+\/octet-stream)/i,
  video: /^(video\/|application\/(mp4|ogg)|[a-z]+\/octet-stream)/i,
};
/** All that is given out of IPv6. Outside there are ways around: `::7f00:1` is an old spelling of 127.0.0.1. */
const GLOBAL = ipaddr.parseCIDR('2000::/3');

/**
 * A function that fetches a file of a kind, `image` or `video`. `home` is the origin that relative addresses belong to and the only one
 * that sees a token. Of hosts in private networks, loopback and all else that is not public it fetches from `home` and the origins in
 * `allow` alone.
 */
export function createFetch({ home, allow = [], largest = LARGEST, patience = PATIENCE, lookup = systemLookup } = {}) {
  const named = new Set([...(home ? [home] : []), ...allow].map(originOf));

  return async function fetchFile(address, { token, signal, kind = 'image' } = {}) {
    signal?.throwIfAborted();
    const limit = new AbortController();
    const timer = setTimeout(() => limit.abort(refused(address, `takes longer than ${patience} ms`)), patience);
    const follow = () => limit.abort(signal.reason);
    signal?.addEventListener('abort', follow);
    try {
      return await fetched(address, kind, token, limit.signal);
    } catch (error) {
      if (limit.signal.aborted) throw limit.signal.reason;
      throw error instanceof Refusal ? error : refused(address, `cannot be fetched: ${error.message}`);
    } finally {
      clearTimeout(timer);
      signal?.removeEventListener('abort', follow);
    }
  };

  async function fetched(address, kind, token, signal) {
    if (/^data:/i.test(address)) return inline(address);
    let url = resolved(address, home);
    // A stranger who redirects back home does not get to ask there in our name.
    let trusted = true;
    for (let hop = 0; hop <= REDIRECTS; hop++) {
      trusted &&= url.origin === home;
      const response = await get(url, trusted && token ? await authorization(token, address, signal) : undefined, signal);
      const next = [301, 302, 303, 307, 308].includes(response.statusCode) ? response.headers.location : undefined;
      if (next === undefined) return content(response, address, kind, url);
      response.destroy();
      url = resolved(next, url);
    }
    throw refused(address, `is redirected more than ${REDIRECTS} times`);
  }

  /** Of a personal access token Label Studio makes one that opens its files for some minutes. Legacy tokens open them as they are. */
  async function authorization(token, address, signal) {
    if (!/^[^.]+\.[^.]+\.[^.]+$/.test(token)) return `Token ${token}`;
    const headers = { 'Content-Type': 'application/json' };
    const request = { method: 'POST', headers, body: JSON.stringify({ refresh: token }), redirect: 'error', signal };
    const response = await fetch(new URL('/api/token/refresh', home), request);
    if (!response.ok) throw refused(address, unopened(response.status));
    return `Bearer ${(await response.json()).access}`;
  }

  function get(url, authorization, signal) {
    const host = url.hostname.replace(/^\[|\]$/g, '');
    const free = named.has(url.origin);
    if (!free && isIP(host)) checkAddress(host, url);
    // Label Studio answers 406 to who wants images alone.
    const headers = { Accept: '*/*', 'Accept-Encoding': 'identity', ...(authorization && { Authorization: authorization }) };
    const request = url.protocol === 'https:' ? secureRequest : plainRequest;
    const options = { agent: false, headers, signal, lookup: free ? lookup : checkedLookup(url) };
    return new Promise((resolve, reject) => request(url, options).once('response', resolve).on('error', reject).end());
  }

  /** The connection goes to the very addresses that were looked at: asked again, the name could have others. */
  function checkedLookup(url) {
    return (host, options, callback) =>
      lookup(host, { ...options, all: true }, (error, found) => {
        try {
          if (error) throw error;
          if (found.length === 0) throw new Error(`${host} has no address`);
          for (const { address } of found) checkAddress(address, url);
        } catch (problem) {
          return callback(problem);
        }
        return options.all ? callback(null, found) : callback(null, found[0].address, found[0].family);
      });
  }

  async function content(response, address, kind, { origin }) {
    const { statusCode: status, headers } = response;
    const problem = () => {
      if (origin === home && [401, 403].includes(status)) return unopened(status);
      if (status < 200 || status > 299) return `answered ${status}`;
      const type = headers['content-type'];
      if (type !== undefined && !TYPES[kind].test(type)) return `is ${type}, not ${kind === 'image' ? 'an image' : 'a video'}`;
      return undefined;
    };
    const found = problem();
    if (found) {
      response.destroy();
      throw refused(address, found);
    }
    const pieces = [];
    let length = 0;
    for await (const piece of response) {
      length += piece.length;
      if (length > largest) throw refused(address, `has more than ${largest} bytes`, 'unreadable-file');
      pieces.push(piece);
    }
    return new Uint8Array(Buffer.concat(pieces));
  }
}

/** The origin of an address that the one who runs the server wrote. */
export function originOf(text) {
  const url = URL.canParse(text) ? new URL(text) : undefined;
  if (!url || !/^https?:$/.test(url.protocol)) throw new Error(`'${text}' is not an address of http or https`);
  return url.origin;
}

function unopened(status) {
  return `answered ${status}: see LABEL_STUDIO_API_KEY in label-studio.md`;
}

async function inline(address) {
  try {
    return new Uint8Array(await (await fetch(address)).arrayBuffer());
  } catch {
    throw refused(address, 'cannot be read', 'unreadable-file');
  }
}

function resolved(address, base) {
  if (!URL.canParse(address, base)) {
    const hint = base ? 'is no address' : 'is a file of Label Studio: set LABEL_STUDIO_URL and LABEL_STUDIO_API_KEY';
    throw refused(address, hint, 'invalid-input');
  }
  const url = new URL(address, base);
  if (!/^https?:$/.test(url.protocol)) throw refused(address, 'must be an address of http, https or data', 'invalid-input');
  if (url.username || url.password) throw refused(url.origin, 'is no place for a password', 'invalid-input');
  return url;
}

function checkAddress(address, { origin }) {
  const parsed = ipaddr.process(address);
  if (parsed.range() === 'unicast' && (parsed.kind() === 'ipv4' || parsed.match(GLOBAL))) return;
  throw refused(origin, `is not public (${address}): start the server with --allow ${origin}`, 'address-refused');
}

function refused(address, what, code = 'file-not-found') {
  const text = String(address);
  return new Refusal(422, code, `${text.length > 200 ? `${text.slice(0, 200)}…` : text} ${what}`);
}
