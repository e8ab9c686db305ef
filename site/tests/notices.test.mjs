// The site names everything that it contains of others.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import { missingNotices } from '../../scripts/lib/site.mjs';

const html = readFileSync(new URL('../../out/site/licences/index.html', import.meta.url), 'utf8');

test('the page of licences lacks nothing', () => {
  assert.deepEqual(missingNotices(html), []);
});

test('a licence that is left out is missed', () => {
  assert.deepEqual(missingNotices(html.replaceAll('Pagefind', 'Search')), ['Pagefind']);
  assert.deepEqual(missingNotices(html.replaceAll('Permission is hereby granted', '')).slice(0, 1), ['LICENSE-MIT']);
});
