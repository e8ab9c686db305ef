// custom-elements.json, from which editors and documentation know the element, says what the element has: no more and no less.

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

test('its members are those of the types', () => {
  const [, body] = /export class VeroneseSegmenterElement extends HTMLElement \{\n(.*?)\n\}/s.exec(types);
  const declared = body.replaceAll(/\/\*\*.*?\*\//gs, '').split('\n').map((line) => line.trim());
  const members = {};
  for (const line of declared) {
    const [, readonly, field, type] = /^(readonly )?(\w+): (.*);$/.exec(line) ?? /^()get (\w+)\(\): (.*);$/.exec(line) ?? [];
    if (field) members[field] = { readonly: readonly ? true : undefined, type };
    const [, method, parameters, result] = /^(\w+)\((.*)\): (.*);$/.exec(line) ?? [];
    if (method && method !== 'addEventListener') members[method] = { parameters, type: result };
  }
  assert.ok(Object.keys(members).length > 20);
  const written = element.members.map(({ name, kind, readonly, type, parameters, return: result }) => {
    if (kind === 'field') return [name, { readonly, type: type.text }];
    return [name, { parameters: parameters.map((one) => `${one.name}${one.optional ? '?' : ''}: ${one.type.text}`).join(', '), type: result.type.text }];
  });
  assert.deepEqual(Object.fromEntries(written), members);
});

test('its attributes are those that the element has', () => {
  // A disabled control is told by the browser, not by the attribute.
  assert.deepEqual(names(element.attributes), [...VeroneseSegmenterElement.observedAttributes, 'disabled'].sort());
  for (const { fieldName } of element.attributes) if (fieldName) assert.ok(names(element.members).includes(fieldName), fieldName);
  const [, attributes] = /interface VeroneseSegmenterAttributes \{\n(.*?)\n\}/s.exec(read('types/markup.d.ts'));
  assert.deepEqual(names(element.attributes), found(/^ {2}(\w+)\?:/gm, attributes));
});

test('its events are those of the types', () => {
  const [, body] = /interface VeroneseSegmenterEvents \{\n(.*?)\n\}/s.exec(types);
  const declared = [...body.matchAll(/^ {2}'?([\w-]+)'?: (.*);$/gm)].map(([, name, type]) => [name, `CustomEvent<${type}>`]);
  assert.ok(declared.length > 5);
  assert.deepEqual(element.events.map(({ name, type }) => [name, type.text]), declared);
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
