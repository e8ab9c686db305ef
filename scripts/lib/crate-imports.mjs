// Which file of the crate uses which: files that use each other, directly or by way of others, cannot be read or changed alone. oxlint looks
// for the same in TypeScript and JavaScript; for Rust there is no tool that knows files.

import { readdirSync } from 'node:fs';
import { join } from 'node:path';

import { projectText, root } from './project.mjs';
import { say } from './run.mjs';

/** The top modules of `src`: each may use those before it. */
const ORDER =
  `error exponential hash lanes model motion order random side frame linear measurements recording progress options codecs components
  embedding refinement view answer factorisation estimation best labelling paper pair clip points literal stages`.split(/\s+/);

/** Whether no files use each other, and top modules only those before them. Prints what differs. */
export function crateImportsAgree() {
  const uses = usesOf(sources());
  const circle = inCircles(uses);
  const problems = circle.map(
    (file) => `${file} is in a circle with ${[...uses.get(file)].filter((other) => circle.includes(other)).join(' ')}.`,
  );
  const top = (file) => file.split('/')[0].replace('.rs', '');
  for (const [file, others] of uses) {
    for (const other of file === 'lib.rs' ? [] : others) {
      if (ORDER.indexOf(top(other)) > ORDER.indexOf(top(file)) || !ORDER.includes(top(other)))
        problems.push(`${file} uses ${other}, which comes after it.`);
    }
  }
  for (const problem of problems) say(problem);
  return problems.length === 0;
}

/** Every file below `src` without its tests and comments, by its path there. */
function sources() {
  const files = readdirSync(join(root, 'src'), { recursive: true }).map((path) => String(path).replaceAll('\\', '/'));
  const own = files.filter((path) => path.endsWith('.rs') && !/(^|\/)tests(\/|\.rs$)/.test(path));
  return new Map(own.map((path) => [path, withoutTests(projectText(`src/${path}`))]));
}

function withoutTests(source) {
  const code = source.replace(/\/\/.*$/gm, '');
  const tests = /^#\[cfg\(test\)\]\n(pub\(crate\) )?mod \w+ \{$/m.exec(code);
  return tests ? code.slice(0, tests.index) : code;
}

/** For each file those that it uses. What a file passes on from its modules, by `mod` or `pub use`, does not count, and is followed. */
export function usesOf(files) {
  const modules = new Map(
    [...files].map(([path, text]) => {
      const place = path === 'lib.rs' ? [] : path.replace(/(\/mod)?\.rs$/, '').split('/');
      const children = new Set([...text.matchAll(/\bmod (\w+);/g)].map(([, name]) => name));
      const imports = [...text.matchAll(/\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);/g)].map(([, isPassed, tree]) => ({
        isPassed,
        paths: expanded(tree),
      }));
      return [place.join('::'), { path, place, children, imports, code: text.replace(/\b(?:pub(?:\([^)]*\))?\s+)?use\s+[^;]+;/g, '') }];
    }),
  );
  /** The segments from the top of the crate; undefined if they are another crate's. */
  const absolute = ({ place, children }, [first, ...rest]) => {
    if (first === 'crate') return rest;
    if (first === 'self') return [...place, ...rest];
    if (first === 'super')
      return rest[0] === 'super' ? absolute({ place: place.slice(0, -1), children }, rest) : [...place.slice(0, -1), ...rest];
    return children.has(first) ? [...place, first, ...rest] : undefined;
  };
  /** The file that has what stands at a path. */
  const fileOf = (segments, depth = 0) => {
    let length = segments.length;
    while (length > 0 && !modules.has(segments.slice(0, length).join('::'))) length -= 1;
    const found = modules.get(segments.slice(0, length).join('::'));
    const name = segments[length];
    for (const { isPassed, paths } of found.imports) {
      const passed = isPassed && depth < 8 && paths.find(({ as }) => as === name);
      const target = passed && absolute(found, passed.segments);
      if (target) return fileOf([...target, ...segments.slice(length + 1)], depth + 1);
    }
    return found.path;
  };
  return new Map(
    [...modules.values()].map((module) => {
      const inCode = [...module.code.matchAll(/(?<![\w:])(\w+(?:::\w+)+)/g)].map(([, path]) => path.split('::'));
      const inUses = module.imports.flatMap(({ isPassed, paths }) =>
        paths.map(({ segments }) => segments).filter(([first]) => !(isPassed && module.children.has(first))),
      );
      const targets = [...inCode, ...inUses].map((segments) => absolute(module, segments)).filter((segments) => segments !== undefined);
      return [module.path, new Set(targets.map((segments) => fileOf(segments)).filter((path) => path !== module.path))];
    }),
  );
}

/** `a::{b, c::{d as e}}` as its paths, with the name that each has here. */
function expanded(tree, before = []) {
  const text = tree.trim();
  const brace = text.indexOf('{');
  const head = (brace < 0 ? text : text.slice(0, brace)).split(/\s+as\s+/);
  const segments = [
    ...before,
    ...head[0]
      .split('::')
      .map((part) => part.trim())
      .filter(Boolean),
  ];
  if (brace < 0) {
    const own = segments.at(-1) === 'self' && segments.length > 1 ? segments.slice(0, -1) : segments;
    return [{ segments: own, as: head[1] ?? own.at(-1) }];
  }
  let [depth, from, parts] = [0, brace + 1, []];
  for (let k = brace; k < text.length; k += 1) {
    if (text[k] === '{') depth += 1;
    if (text[k] === '}') depth -= 1;
    if ((text[k] === ',' && depth === 1) || depth === 0) {
      parts = [...parts, text.slice(from, k)];
      from = k + 1;
    }
    if (depth === 0) break;
  }
  return parts.filter((part) => part.trim() !== '').flatMap((part) => expanded(part, segments));
}

/** The files that use themselves by way of others, sorted. */
export function inCircles(uses) {
  const reaches = (file, wanted, seen = new Set()) =>
    [...uses.get(file)].some((other) => other === wanted || (!seen.has(other) && seen.add(other) && reaches(other, wanted, seen)));
  return [...uses.keys()].filter((file) => reaches(file, file)).sort();
}
