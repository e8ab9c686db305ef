// Which files of a crate use each other: what counts, and what a parent only passes on.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { inCircles, usesOf } from '../../../scripts/lib/crate-imports.mjs';

const uses = (files) => Object.fromEntries([...usesOf(new Map(Object.entries(files)))].map(([path, others]) => [path, [...others].sort()]));

test('use statements and paths in the code count, with braces, other names and modules in folders', () => {
  const found = uses({
    'lib.rs': 'pub mod a;\nmod b;\nmod c;',
    'a.rs': 'use crate::{b::{self, Thing as Other}, c::deep::value};\nuse serde::Serialize;',
    'b.rs': 'fn f() { crate::c::deep::value() }\npub struct Thing;',
    'c/mod.rs': 'mod deep;',
    'c/deep.rs': 'use super::super::b;\npub fn value() {}',
  });
  assert.deepEqual(found, { 'lib.rs': [], 'a.rs': ['b.rs', 'c/deep.rs'], 'b.rs': ['c/deep.rs'], 'c/mod.rs': [], 'c/deep.rs': ['b.rs'] });
});

test('what a parent passes on is no use of its own, and leads to where it is', () => {
  const files = {
    'lib.rs': 'mod a;\nmod b;\npub use a::Thing;',
    'a.rs': 'mod inner;\npub(crate) use inner::Thing;',
    'a/inner.rs': 'use crate::b::other;\npub struct Thing;',
    'b.rs': 'use crate::Thing;\npub fn other() {}',
  };
  assert.deepEqual(uses(files)['a.rs'], []);
  assert.deepEqual(uses(files)['b.rs'], ['a/inner.rs']);
  assert.deepEqual(inCircles(usesOf(new Map(Object.entries(files)))), ['a/inner.rs', 'b.rs']);
});
