// Chosen numbers stand in src/model.rs. This counts them, and finds numbers in the code of the pipelines that are neither there nor explained.

import { readdirSync } from 'node:fs';
import { join } from 'node:path';

import { projectText, root } from './project.mjs';
import { say } from './run.mjs';

/** The most constants that a model may have. */
const MOST = { Model: 60, ClipModel: 30 };
const FOLDERS = ['src/pair', 'src/estimation', 'src/labelling', 'src/view', 'src/clip'];
const FILES = ['src/pair.rs', 'src/clip.rs'];
/** Units, halves and the largest byte are no choices; smaller numbers keep a division or a logarithm from zero. */
const PLAIN = new Set([0, 0.5, 1, 2, 255]);
const GUARD = 1e-5;
const LITERAL = /(?<![\w.])\d[\d_]*(?:\.[\d_]+(?:e-?\d+)?|e-?\d+)/g;

/** Whether the models are within their limits and every other number says in a comment where it comes from. Prints the counts. */
export function constantsAreFew() {
  const problems = [...modelProblems(), ...sources().flatMap((file) => unexplained(file, projectText(file)))];
  for (const problem of problems) say(problem);
  return problems.length === 0;
}

function modelProblems() {
  const problems = [];
  for (const [, block] of projectText('src/model.rs').matchAll(/^model! \{\n([\s\S]*?)^\}/gm)) {
    const name = /^ {4}(\w+) of/m.exec(block)[1];
    const count = [...block.matchAll(/^ {4}\w+: \w+ = /gm)].length;
    say(`${name}: ${count} constants`);
    if (count > MOST[name]) problems.push(`${name} has more than ${MOST[name]} constants.`);
  }
  return problems;
}

function sources() {
  const inFolders = FOLDERS.flatMap((folder) =>
    readdirSync(join(root, folder), { recursive: true }).filter((name) => name.endsWith('.rs') && !name.includes('tests')).map((name) => `${folder}/${name}`));
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
    if (chosen.length > 0) problems.push(`${file}:${k + 1} has the number ${chosen.join(', ')}: it belongs in src/model.rs, or a comment says how it follows.`);
  }
  return problems;
}
