// The guide's pages: front matter, prose and fenced blocks.

import { readFileSync, readdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

export const GUIDE = fileURLToPath(new URL('../../pages/guide/', import.meta.url));

/** All pages by name. */
export function pages() {
  return readdirSync(GUIDE)
    .filter((name) => name.endsWith('.md') && name !== 'index.md')
    .sort()
    .map((name) => page(name.replace('.md', '')));
}

/** One page; its `blocks` are the fences in order, its `prose` is everything between them. */
function page(name) {
  const file = `${GUIDE}${name}.md`;
  const text = readFileSync(file, 'utf8');
  const [, front, body] = /^---\n([\s\S]*?)\n---\n([\s\S]*)$/.exec(text) ?? [];
  if (front === undefined) throw new Error(`${name}.md has no front matter`);
  const data = Object.fromEntries(front.split('\n').map((line) => /^(\w+): (.*)$/.exec(line).slice(1)));
  const blocks = [...text.matchAll(/^```([^\n]*)\n([\s\S]*?)^```$/gm)].map(({ 1: info, 2: code, index }) => {
    const [language, file] = info.split(' ');
    return { language, file, code, line: text.slice(0, index).split('\n').length };
  });
  const fences = text.split('\n').filter((line) => line.startsWith('```')).length;
  if (fences !== 2 * blocks.length) throw new Error(`${name}.md has a fence that is not closed`);
  return { name, file, text, data, body, blocks: withOutputs(blocks, name), prose: body.replaceAll(/^```[\s\S]*?^```$/gm, '') };
}

/** The output of a block is the block of text that comes next; it belongs to the block and is none of its own. */
function withOutputs(blocks, name) {
  const found = [];
  for (const block of blocks) {
    const last = found.at(-1);
    if (block.language !== 'text') found.push({ ...block });
    else if (last && last.output === undefined) last.output = block;
    else throw new Error(`${name}.md:${block.line}: a block of text that no code prints`);
  }
  return found;
}

/** Whether an output is that of a page: `…` stands for anything in a line, and alone in a line for any lines. */
export function matches(printed, said) {
  const lines = said.trimEnd().split('\n').map((line) => line.trimEnd());
  const pattern = lines
    .map((line) => (line.trim() === '…' ? '(?:.*\\n)*?' : `${line.split('…').map(escaped).join('.*?')}\\n`))
    .join('');
  return new RegExp(`^${pattern}$`).test(`${trimmed(printed)}\n`);
}

/** Without spaces at the ends of lines, and without empty lines at the end. */
export function trimmed(text) {
  return text.trimEnd().split('\n').map((line) => line.trimEnd()).join('\n');
}

function escaped(text) {
  return text.replaceAll(/[\\^$.*+?()[\]{}|]/g, '\\$&');
}
