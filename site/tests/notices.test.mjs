// The site names everything that it contains of others.

import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { test } from 'node:test';

import { missingNotices } from '../../scripts/lib/site.mjs';

const SITE = new URL('../../out/site/', import.meta.url);
const html = readFileSync(new URL('licences/index.html', SITE), 'utf8');

test('the page of licences lacks nothing', async () => {
  assert.deepEqual(await missingNotices(html), []);
});

test('a licence that is left out is missed', async () => {
  assert.equal((await missingNotices(html.replace('Copyright (c) Pagefind', ''))).length, 1);
  assert.ok((await missingNotices(html.replaceAll('Permission is hereby granted', ''))).includes('LICENSE-MIT'));
});

test('the fonts and scripts of rustdoc come with their licences', () => {
  const files = readdirSync(new URL('reference/crate/static.files/', SITE)).join(' ');
  for (const name of ['COPYRIGHT', 'FiraSans-LICENSE', 'LICENSE-APACHE', 'LICENSE-MIT', 'SourceCodePro-LICENSE', 'SourceSerif4-LICENSE']) assert.match(files, new RegExp(name));
});
