//! The command line and the JavaScript that give the same masks.

import type { Clip } from '../clips/clip.js';
import { quoted } from '../common/shell.js';
import type { LoadedFrame } from '../state/pair.js';
import { DEFAULT_SETTINGS, type Settings } from '../state/settings.js';
import type { Look, Result } from '../state/state.js';

/** Settings that differ from the defaults, as options of the package. */
function changed(settings: Settings): Partial<Settings> {
  const { longestSide: _, ...options } = settings;
  return Object.fromEntries(Object.entries(options).filter(([name, value]) => value !== DEFAULT_SETTINGS[name as keyof Settings]));
}

/** The file name of a frame, and the command that extracts it from a video first. */
function found({ name, origin }: LoadedFrame): { name: string; before: string[] } {
  if (origin === undefined || origin.clip.times === null) return { name, before: [] };
  const { clip, index } = origin;
  const file = `frame-${index}.png`;
  return { name: file, before: [`ffmpeg -i ${quoted(clip.name)} ${selecting(clip, index)} ${file}`] };
}

/** The ffmpeg options that select a frame: by index, or for inexact clips the last frame before the time to which the page seeks. */
function selecting({ exact, times }: Clip, index: number): string {
  if (exact) return `-vf 'select=eq(n\\,${index})' -frames:v 1`;
  const [begun, next] = [times![index]!, times![index + 1] ?? times![index]!];
  const time = (begun + next) / 2;
  return `-vf 'select=between(t\\,${(time - 1).toFixed(3)}\\,${time.toFixed(3)})' -update 1`;
}

export function commandFor({ pair }: Result, settings: Settings, look: Look): string {
  const [first, second] = [found(pair.first), found(pair.second)];
  const { motions, quality, subject, markUnknown } = changed(settings);
  const options = [
    motions === undefined ? '' : `--motions ${motions}`,
    quality === undefined ? '' : `--quality ${quality}`,
    subject ? '--subject' : '',
    look.kind === 'groups' ? '--grouped' : '',
    markUnknown ? '--mark-unknown' : '',
  ];
  const words = ['veronese pair', quoted(first.name), quoted(second.name), ...options.filter((option) => option !== ''), '--out masks --overlay'];
  return [...new Set([...first.before, ...second.before]), words.join(' ')].join('\n');
}

export function scriptFor({ pair }: Result, settings: Settings, look: Look): string {
  const [first, second] = [found(pair.first).name, found(pair.second).name];
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
