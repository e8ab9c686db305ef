// The measured figures of the documentation: docs/figures/NAME.json, one file for each measurement. `npm run figures` and the site write their
// tables from them.

import { renameSync, writeFileSync } from 'node:fs';
import { cpus } from 'node:os';
import { join } from 'node:path';

import { projectText, root } from './project.mjs';

/** Digits of a number that are kept; more would be noise. */
const DIGITS = 4;
/** Levels of a file whose entries have a line each. */
const LEVELS = 2;

export function figuresOf(name) {
  return JSON.parse(projectText(`docs/figures/${name}.json`));
}

/**
 * The measurements of a command, with where they come from. `origin` has the `command`, on which `data` constants were chosen and which were held
 * out, and programs with their versions that belong to the machine.
 */
export function withOrigin({ command, data, ...programs }, measured) {
  return {
    date: new Date().toISOString().slice(0, 10),
    version: JSON.parse(projectText('package.json')).version,
    machine: { processor: cpus()[0].model, cores: cpus().length, ...programs },
    command,
    data,
    ...measured,
  };
}

export function writeFigures(name, figures) {
  const path = join(root, `docs/figures/${name}.json`);
  writeFileSync(`${path}.new`, `${inLines(rounded(figures))}\n`);
  renameSync(`${path}.new`, path);
  console.log(`Written to docs/figures/${name}.json.`);
}

function rounded(value) {
  if (typeof value === 'number') return Number.isInteger(value) ? value : Number(value.toPrecision(DIGITS));
  if (Array.isArray(value)) return value.map(rounded);
  if (typeof value !== 'object' || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([name, entry]) => [name, rounded(entry)]));
}

/** JSON that is compact, and yet has lines to compare. */
function inLines(value, level = 0) {
  if (level === LEVELS || typeof value !== 'object' || value === null) return JSON.stringify(value);
  const list = Array.isArray(value);
  const entries = Object.entries(value)
    .filter(([, entry]) => entry !== undefined)
    .map(([name, entry]) => `${list ? '' : `${JSON.stringify(name)}: `}${inLines(entry, level + 1)}`);
  if (entries.length === 0 || (list && value.every((entry) => typeof entry !== 'object'))) return JSON.stringify(value);
  const [begin, end] = list ? '[]' : '{}';
  const indent = '  '.repeat(level + 1);
  return `${begin}\n${indent}${entries.join(`,\n${indent}`)}\n${indent.slice(2)}${end}`;
}
