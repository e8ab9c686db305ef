// The schemas of result.json and tracks.json, asked by a validator about what the program writes. Here, unlike in the schemas that are shipped,
// no other properties are allowed: each is described.

import assert from 'node:assert/strict';
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import Ajv from 'ajv/dist/2020.js';
import { davisPng } from '../build/formats/pictures.js';
import { clip as framesOf, tracksOf } from './support/folders.mjs';
import { frame } from './support/frames.mjs';
import { veronese } from './support/program.mjs';

const schemaOf = (name) => JSON.parse(readFileSync(new URL(import.meta.resolve(`veronese/${name}.schema.json`)), 'utf8'));
const ajv = new Ajv({ allErrors: true, strict: true, allowUnionTypes: true });
const validators = Object.fromEntries(['result', 'tracks'].map((name) => [name, ajv.compile({ ...closed(schemaOf(name)), $id: name })]));
const seen = { result: new Set(), tracks: new Set() };

function closed(schema) {
  if (typeof schema !== 'object' || schema === null) return schema;
  if (Array.isArray(schema)) return schema.map(closed);
  const all = Object.fromEntries(Object.entries(schema).map(([key, value]) => [key, closed(value)]));
  return schema.type === 'object' && schema.properties ? { additionalProperties: false, ...all } : all;
}

function check(name, document) {
  validators[name](document);
  assert.deepEqual(validators[name].errors, null);
  for (const key of Object.keys(document)) seen[name].add(key);
}

function everyPropertyWasSeen(name) {
  assert.deepEqual([...seen[name]].sort(), Object.keys(schemaOf(name).properties).sort());
}

const json = (...path) => JSON.parse(readFileSync(join(...path), 'utf8'));

async function run(...args) {
  const { code, stdout, stderr } = await veronese([...args, '--quality', 'fast']);
  assert.equal(code, 0, stderr);
  return stdout;
}

test('result.json of pairs and of batches', async (t) => {
  const { frames, one, path } = framesOf(t, 3);
  check('result', JSON.parse(await run('pair', one(0), one(2), '--mark-unknown', '--out', path('pair'))));
  check('result', json(path('pair'), 'result.json'));
  // Two frames that are one have a note.
  check('result', JSON.parse(await run('pair', one(0), one(0))));
  await run('batch', frames, '--out', path('batch'));
  for (const name of readdirSync(path('batch')).filter((name) => !name.startsWith('.'))) check('result', json(path('batch'), name, 'result.json'));
  everyPropertyWasSeen('result');
});

test('tracks.json of clips, with corrections too', async (t) => {
  const { frames, out, path } = framesOf(t, 3);
  await run('clip', frames, '--out', out, '--show', 'sheet.png');
  check('tracks', tracksOf(out));
  mkdirSync(path('said'));
  writeFileSync(path('said', 'edits.json'), '{"names": {"1": "square"}}');
  writeFileSync(path('said', 'f0.png'), davisPng(new Uint8Array(64 * 48).map((_, p) => (p < 64 * 24 ? 3 : 255)), 64, 48));
  await run('clip', frames, '--out', out, '--corrections', path('said'));
  check('tracks', tracksOf(out));
  const still = framesOf(t, 2, () => frame(0));
  await run('clip', still.frames, '--out', still.out, '--look-ahead', '1');
  // Only videos have times.
  check('tracks', { ...tracksOf(still.out), frameRate: 25, timestamps: [0, 0.04] });
  everyPropertyWasSeen('tracks');
});

test('another version, a label that is none and a list that is too short are refused', () => {
  for (const change of [{ version: 2 }, { width: 0 }, { frames: [1] }, { objects: [{ id: 255 }] }, { background: [{ frame: 0, matrix: [1] }] }]) {
    const { ...tracks } = { version: 1, width: 64, height: 48, frames: [], files: [], objects: [], background: [], dropped: 0 };
    assert.equal(validators.tracks({ ...tracks, ...change }), false);
  }
});
