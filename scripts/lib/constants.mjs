// Chosen numbers have a name, a unit and a reason, in src/model.rs or beside their algorithm. This finds numbers in the code of the pipelines
// that no comment explains.

import { readdirSync } from 'node:fs';
import { join } from 'node:path';

import { projectText, root } from './project.mjs';
import { say } from './run.mjs';

const FOLDERS = ['src/pair', 'src/estimation', 'src/labelling', 'src/view', 'src/clip'];
const FILES = ['src/pair.rs', 'src/clip.rs'];
/** Units, halves and the largest byte are no choices; smaller numbers keep a division or a logarithm from zero. */
const PLAIN = new Set([0, 0.5, 1, 2, 255]);
const GUARD = 1e-5;
const LITERAL = /(?<![\w.])\d[\d_]*(?:\.[\d_]+(?:e-?\d+)?|e-?\d+)/g;

/** Whether every number has a comment with its source. Prints those that have none. */
export function constantsAreExplained() {
  const problems = sources().flatMap((file) => unexplained(file, projectText(file)));
  for (const problem of problems) say(problem);
  return problems.length === 0;
}

function sources() {
  const inFolders = FOLDERS.flatMap((folder) =>
    readdirSync(join(root, folder), { recursive: true })
      .filter((name) => name.endsWith('.rs') && !name.includes('tests'))
      .map((name) => `${folder}/${name}`),
  );
  return [...FILES, ...inFolders];
}

/** Lines with a number that is neither plain nor explained, on the line itself or right above it. */
export function unexplained(file, text) {
  const lines = text.split(/#\[cfg\(test\)\]\n(?:pub\(crate\) )?mod tests/)[0].split('\n');
  const problems = [];
  for (const [k, line] of lines.entries()) {
    const [code, comment] = line.split('//');
    const explained = comment !== undefined || lines[k - 1]?.trimStart().startsWith('//');
    if (explained) continue;
    const numbers = (code.replaceAll(/"[^"]*"/g, '').match(LITERAL) ?? []).map((number) => Number(number.replaceAll('_', '')));
    const chosen = numbers.filter((number) => !PLAIN.has(number) && number > GUARD);
    if (chosen.length > 0)
      problems.push(`${file}:${k + 1} has the number ${chosen.join(', ')}: a name in src/model.rs or a comment says where it comes from.`);
  }
  return problems;
}
