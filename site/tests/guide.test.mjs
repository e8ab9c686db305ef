// The guide is what its code does: every block of every page runs here, in the order of the page, and prints the output on the page.
// `VERONESE_GUIDE=write` writes what was printed into the pages, but for blocks with `…`.

import assert from 'node:assert/strict';
import { existsSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, describe, test } from 'node:test';

import { projectText, root } from '../../scripts/lib/project.mjs';
import identity from '../data/identity.mjs';
import { GUIDE, matches, pages, trimmed } from './support/pages.mjs';
import { readersFolder } from './support/reader.mjs';
import { RUNNERS } from './support/runners.mjs';
import { closeBrowser } from './support/show.mjs';

const MOST_WORDS = 600;
const LARGEST_IMAGE = 80 * 1024;
const WRITES = process.env.VERONESE_GUIDE === 'write';
/** Pages by name, to run some alone: `VERONESE_GUIDE_PAGES=start,pairs`. */
const ONLY = process.env.VERONESE_GUIDE_PAGES?.split(',');

const all = pages();
const { version } = JSON.parse(projectText('pkg/package.json'));
const counts = { run: 0, skipped: 0 };

after(closeBrowser);

for (const page of all.filter(({ name }) => ONLY?.includes(name) ?? true)) {
  describe(`${page.name}.md`, () => {
    test('its blocks do what it says', async (t) => {
      const folder = readersFolder(t);
      for (const block of page.blocks) {
        const title = `line ${block.line}: ${block.language}${block.file ? ` ${block.file}` : ''}`;
        await t.test(title, (t) => runBlock(t, { page, folder, block }));
      }
      if (WRITES) writePage(page);
    });

    test('its form', () => {
      assert.deepEqual(Object.keys(page.data), ['title', 'description', 'order']);
      assert.ok(page.blocks.length > 0, 'it shows code');
      assert.doesNotMatch(page.prose, /^# /m, 'the template prints the title');
      assert.doesNotMatch(page.body, /\{\{|\{%|\{#/, 'the template engine would read it');
      assert.doesNotMatch(page.prose, /^(?:- )?What /m, 'whatever has a name is called by it');
      const words = wordsOf(page.prose);
      assert.ok(words <= MOST_WORDS, `${words} words`);
    });

    test('its links and pictures are there', () => {
      for (const [, picture, target] of page.prose.matchAll(/(!?)\[[^\]]*\]\(([^)\s]+)\)/g)) {
        const problem = picture ? pictureProblem(target) : linkProblem(target);
        assert.equal(problem, undefined, target);
      }
    });

    test('it speaks of this version', () => {
      for (const [, found] of page.text.matchAll(/veronese@(\d+\.\d+\.\d+)/g)) assert.equal(found, version);
    });
  });
}

describe('the guide', { skip: ONLY && 'only some pages were asked for' }, () => {
  test('no block is left out', (t) => {
    const blocks = all.flatMap(({ blocks }) => blocks);
    assert.ok(blocks.length >= 50);
    assert.equal(counts.run + counts.skipped, blocks.length);
    t.diagnostic(`${counts.run} blocks ran, ${counts.skipped} skipped, ${blocks.filter(({ output }) => output).length} outputs compared`);
  });

  test('the pages have different places', () => {
    const orders = all.map(({ data }) => Number(data.order));
    assert.equal(new Set(orders).size, all.length);
    assert.ok(orders.every((order) => order > 0 && order % 10 === 0));
  });

  test('the page of errors has every code of the types, and no other', () => {
    const types = projectText('pkg/types/index.d.ts');
    const [, union] = /export type ErrorCode =\n([\s\S]*?);\n/.exec(types);
    const known = [...union.matchAll(/\| '([a-z-]+)'/g)].map(([, code]) => code);
    const { prose } = all.find(({ name }) => name === 'errors');
    const said = [...prose.matchAll(/^\| `([a-z-]+)` \|/gm)].map(([, code]) => code);
    assert.deepEqual(said.sort(), known.sort());
  });
});

async function runBlock(t, { page, folder, block }) {
  const run = RUNNERS[block.language];
  assert.ok(run, `${page.name}.md:${block.line}: nothing runs '${block.language}'`);
  const printed = await run({ t, folder, block, note: (sentence) => t.diagnostic(sentence) });
  if (printed.skip) {
    counts.skipped += 1;
    t.skip(printed.skip);
    return;
  }
  counts.run += 1;
  block.printed = trimmed(printed);
  const { output } = block;
  if (!output || (WRITES && !output.code.includes('…'))) return;
  assert.ok(matches(printed, output.code), `line ${output.line} says\n${output.code}\nbut it printed\n${printed}`);
}

/** Writes the outputs of this run into the page. */
function writePage({ file, text, blocks }) {
  let written = text;
  for (const { code, printed, output } of blocks) {
    if (printed === undefined || !output || output.code.includes('…')) continue;
    const [at, fence] = [written.indexOf(code), `\`\`\`text\n${output.code}\`\`\``];
    const begin = written.indexOf(fence, at + code.length);
    written = `${written.slice(0, begin)}\`\`\`text\n${printed}\n\`\`\`${written.slice(begin + fence.length)}`;
  }
  if (written !== text) writeFileSync(file, written);
}

/** Words of sentences: without tables, pictures and addresses. */
function wordsOf(prose) {
  const text = prose.replaceAll(/^\|.*$/gm, '').replaceAll(/!\[[^\]]*\]\([^)]*\)/g, '').replaceAll(/\]\([^)]*\)/g, ' ');
  return text.split(/\s+/).filter((word) => /\w/.test(word)).length;
}

function pictureProblem(target) {
  const [, name] = /^\.\.\/images\/([\w-]+\.webp)$/.exec(target) ?? [];
  if (!name) return 'pictures are in ../images and have the format WebP';
  const file = join(GUIDE, 'images', name);
  if (!existsSync(file)) return 'there is no such picture';
  return statSync(file).size > LARGEST_IMAGE ? 'the picture is too large' : undefined;
}

/** Other pages, parts of the site, and files of the repository; other sites are not asked. */
function linkProblem(target) {
  const other = /^\.\.\/([\w-]+)\/(?:#[\w-]+)?$/.exec(target)?.[1];
  if (other) return all.some(({ name }) => name === other) ? undefined : 'there is no such page';
  if (/^\.\.\/\.\.\/(?:app|method|reference(?:\/command-line)?|comparison|changes)\/$/.test(target)) return undefined;
  if (target.startsWith(`${identity.repository}/`)) {
    const [, path] = /\/(?:blob|tree|raw)\/main\/([^#]+)/.exec(target) ?? [];
    if (path) return existsSync(join(root, path)) ? undefined : 'there is no such file in the repository';
  }
  return /^(?:https:\/\/|#)/.test(target) ? undefined : 'this is no address';
}
