// custom-elements.json, which the build writes from the types, has what the element has: no more and no less.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { VeroneseSegmenterElement } from 'veronese/element-class';

const read = (path) => readFileSync(new URL(`../${path}`, import.meta.url), 'utf8');
const { modules } = JSON.parse(read('custom-elements.json'));
const element = modules.flatMap(({ declarations }) => declarations).find(({ tagName }) => tagName === 'veronese-segmenter');
const types = read('types/element-class.d.ts');
const sources = readdirSync(new URL('../src/element/', import.meta.url)).map((name) => read(`src/element/${name}`)).join('\n');
const names = (list) => list.map(({ name }) => name).sort();
const found = (pattern, text) => [...new Set([...text.matchAll(pattern)].map(([, name]) => name))].sort();

test('its members and events are in the types', () => {
  assert.ok(element.members.length > 20 && element.events.length > 5);
  for (const { kind, name, parameters = [] } of element.members) {
    assert.match(types, new RegExp(kind === 'method' ? `^ {2}${name}\\(${parameters.map((one) => `${one.name}.*`).join('')}\\): ` : `^ {2}(readonly |get )?${name}\\b`, 'm'));
  }
  for (const { name, description } of element.events) assert.ok(types.includes(`/** ${description} */\n  ${/\W/.test(name) ? `'${name}'` : name}: `), name);
});

test('its attributes are those that the element has', () => {
  // The browser reports a disabled control, not the attribute; style sheets look at the controls.
  assert.deepEqual(names(element.attributes), [...VeroneseSegmenterElement.observedAttributes, 'disabled', 'controls'].sort());
  for (const { fieldName } of element.attributes) if (fieldName) assert.ok(names(element.members).includes(fieldName), fieldName);
});

test('its properties and parts for style sheets are those of the sources', () => {
  const properties = found(/(--veronese-[a-z-]+[a-z])/g, sources).map((name) => (name === '--veronese-colour' ? `${name}-K` : name));
  assert.deepEqual(names(element.cssProperties), properties.sort());
  assert.deepEqual(names(element.cssParts), found(/\bpart\('\w+', '(\w+)'\)/g, sources));
});

test('its modules are files of the package, and one of them registers the tag', () => {
  for (const { path } of modules) assert.ok(read(path).includes('VeroneseSegmenterElement'), path);
  const { path } = modules.find(({ exports }) => exports.some(({ kind, name }) => kind === 'custom-element-definition' && name === 'veronese-segmenter'));
  assert.match(read(path), /customElements\.define/);
});
