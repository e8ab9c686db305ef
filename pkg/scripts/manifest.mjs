// Writes custom-elements.json, from which editors and documentation know the element: its attributes, members and events are those of the
// types, with their comments; part of `npm run build`.

import { readFileSync, writeFileSync } from 'node:fs';

const CSS_PROPERTIES = {
  '--veronese-opacity': 'Opacity of the masks.',
  '--veronese-background': 'Background behind the frame.',
  '--veronese-font': 'Font of the line of status.',
  '--veronese-status-colour': 'Text of the line of status.',
  '--veronese-status-background': 'Background of the line of status.',
  '--veronese-focus-colour': 'Outline of the picture with the focus, and of the chosen object.',
  '--veronese-colour-K': 'Colour of mask K: `--veronese-colour-1` and so on.',
};
const CSS_PARTS = {
  stage: 'The picture, the objects and the line of status.',
  view: 'The picture and the objects, which zoom.',
  picture: 'The frame and its masks.',
  frame: 'The canvas with the frame.',
  masks: 'The canvas with the masks.',
  objects: 'The list box over the picture.',
  object: 'An object in the list box.',
  status: 'The line of status.',
  legend: 'The list of objects and their colours.',
  entry: 'An object in the legend.',
  swatch: 'Its colour.',
  timeline: 'The slider for the frames of a clip.',
  controls: 'The button and the number of the frame of a clip.',
  play: 'The button that plays a clip.',
  number: 'The number of the frame that is shown.',
  progress: 'The progress of a clip.',
};
const CLASS = { name: 'VeroneseSegmenterElement', module: 'dist/element-class.js' };

const read = (name) => readFileSync(new URL(`../types/${name}.d.ts`, import.meta.url), 'utf8');
const [element, markup] = [read('element-class'), read('markup')];

/** The declarations in braces after `head`, each with its comment. A declaration is in one line. */
function declared(text, head) {
  const body = text.slice(text.indexOf(head)).split('\n}')[0];
  const found = body.matchAll(/\n {2}(?:\/\*\*((?:[^*]|\*(?!\/))*)\*\/\n {2})?(['\w].*);(?=\n|$)/g);
  return Array.from(found, ([, comment, code]) => ({ code, ...(comment && { description: worded(comment) }) }));
}

function worded(comment) {
  return comment
    .replaceAll(/\n\s*\*/g, ' ')
    .replaceAll(/\s+/g, ' ')
    .replaceAll(/\{@link (\w+)\}/g, '`$1`')
    .trim();
}

function member({ code, description }) {
  const [, method, parameters, result] = /^(\w+)\((.*)\): (.*)$/.exec(code) ?? [];
  if (method)
    return { kind: 'method', name: method, parameters: [...parametersOf(parameters)], return: { type: { text: result } }, description };
  const [, readonly, name, type] = /^(readonly |get )?(\w+)(?:\(\))?: (.*)$/.exec(code);
  return { kind: 'field', name, type: { text: type }, description, ...(readonly === 'readonly ' && { readonly: true }) };
}

/** `a: A, b?: { c: C }` one by one. */
function* parametersOf(list) {
  for (const [, name, optional, type] of list.matchAll(/(\w+)(\??): ((?:\{.*?\}|[^,])+)/g))
    yield { name, type: { text: type }, ...(optional && { optional: true }) };
}

const described = (list) => Object.entries(list).map(([name, description]) => ({ name, description }));
const members = declared(element, 'export class')
  .filter(({ code }) => !/^(static|set|addEventListener)\b/.test(code))
  .map(member);
const attributes = declared(markup, 'interface VeroneseSegmenterAttributes').map(({ code, description }) => {
  const [, name, type] = /^(\w+)\?: (.*) \| undefined$/.exec(code);
  return { name, type: { text: type }, description, ...(members.some((one) => one.name === name) && { fieldName: name }) };
});
const events = declared(element, 'interface VeroneseSegmenterEvents ').map(({ code, description }) => {
  const [, name, type] = /^'?([\w-]+)'?: (.*)$/.exec(code);
  return { name, type: { text: `CustomEvent<${type}>` }, description };
});
const [, comment] = /\/\*\*((?:[^*]|\*(?!\/))*)\*\/\nexport class/.exec(element);
const declaration = {
  kind: 'class',
  name: CLASS.name,
  tagName: 'veronese-segmenter',
  customElement: true,
  description: worded(comment),
  superclass: { name: 'HTMLElement' },
  attributes,
  members,
  events,
  cssProperties: described(CSS_PROPERTIES),
  cssParts: described(CSS_PARTS),
};
const exported = { kind: 'js', name: CLASS.name, declaration: CLASS };
const modules = [
  { kind: 'javascript-module', path: CLASS.module, declarations: [declaration], exports: [exported] },
  {
    kind: 'javascript-module',
    path: 'dist/element.js',
    declarations: [],
    exports: [{ ...exported, kind: 'custom-element-definition', name: 'veronese-segmenter' }, exported],
  },
];
writeFileSync(new URL('../custom-elements.json', import.meta.url), `${JSON.stringify({ schemaVersion: '2.1.0', modules }, null, 2)}\n`);
