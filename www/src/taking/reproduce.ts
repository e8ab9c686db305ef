//! The same result elsewhere: as a command line, as JavaScript, as a link with the settings. Never the pixels.

import { DEFAULT_SETTINGS } from '../controls.js';
import type { Film, Look, Result, Settings } from '../state.js';

/** What differs from the defaults, as the package's options. */
function changed(settings: Settings): Partial<Settings> {
  const { longestSide: _, ...options } = settings;
  return Object.fromEntries(Object.entries(options).filter(([name, value]) => value !== DEFAULT_SETTINGS[name as keyof Settings]));
}

/** A word that a shell takes as it is. */
function quoted(word: string): string {
  return /^[\w./-]+$/.test(word) && !word.startsWith('-') ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

/** The names under which the frames are found, and how to get them out of a film. */
function frames({ pair }: Result, film: Film | null): { first: string; second: string; before: string[] } {
  if (film === null || film.clip.times === null) return { first: pair.first.name, second: pair.second.name, before: [] };
  const { clip, first, second } = film;
  const name = (index: number): string => `frame-${index}.png`;
  const extract = (index: number): string => `ffmpeg -i ${quoted(clip.name)} -vf 'select=eq(n\\,${index})' -frames:v 1 ${name(index)}`;
  return { first: name(first), second: name(second), before: [extract(first), extract(second)] };
}

export function commandFor(result: Result, settings: Settings, look: Look, film: Film | null): string {
  const { first, second, before } = frames(result, film);
  const { motions, quality, markUnknown, seed } = changed(settings);
  const options = [
    motions === undefined ? '' : `--motions ${motions}`,
    quality === undefined ? '' : `--quality ${quality}`,
    look.kind === 'groups' ? '--grouped' : '',
    markUnknown ? '--mark-unknown' : '',
    seed === undefined ? '' : `--seed ${seed}`,
  ];
  const words = ['veronese pair', quoted(first), quoted(second), ...options.filter((option) => option !== ''), '--out masks --overlay'];
  return [...before, words.join(' ')].join('\n');
}

export function scriptFor(result: Result, settings: Settings, look: Look, film: Film | null): string {
  const { first, second } = frames(result, film);
  const options = Object.entries(changed(settings)).map(([name, value]) => `${name}: ${JSON.stringify(value)}`);
  const given = options.length === 0 ? '' : `, { ${options.join(', ')} }`;
  const grouped = look.kind === 'groups';
  return [
    "import { readFile } from 'node:fs/promises';",
    `import { ${grouped ? 'groupLabels, ' : ''}segmentPair } from 'veronese';`,
    "import { decodeImage } from 'veronese/codecs';",
    '',
    `const first = await decodeImage(await readFile(${JSON.stringify(first)}));`,
    `const second = await decodeImage(await readFile(${JSON.stringify(second)}));`,
    `const result = await segmentPair(first, second${given});`,
    grouped ? 'const masks = groupLabels(result);' : 'const masks = result.labels;',
    '',
  ].join('\n');
}

/** The page's address with the settings behind the `#`, where no server sees them. */
export function linkFor(settings: Settings, { kind }: Look, address: string): string {
  const values = new URLSearchParams();
  for (const [name, value] of Object.entries(settings)) {
    if (value !== DEFAULT_SETTINGS[name as keyof Settings]) values.set(name, String(value));
  }
  if (kind !== 'groups') values.set('masks', kind);
  const url = new URL(address);
  url.hash = values.toString();
  return url.href;
}
