// The lines of a page's shell commands: those that install or download are checked and not run, the others run in a shell.

import { copyFileSync, existsSync, mkdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';

import { projectText, root } from '../../../scripts/lib/project.mjs';
import identity from '../../data/identity.mjs';

const { version } = JSON.parse(projectText('pkg/package.json'));

/** The programs that the shell may run. */
const RUN = ['cat', 'cp', 'echo', 'find', 'head', 'ls', 'mkdir', 'node', 'npx', 'python', 'wc'];

/** Each pattern of a line that is not run, and what is checked of it. */
const CHECKED = [
  [/^npm install ([\w@/.-]+)$/, ([, name]) => isOneOf(name, [identity.npm, `${identity.npm}@${version}`])],
  [/^pip install ([\w=.]+)$/, ([, name]) => isOneOf(name, [identity.python, `${identity.python}==${version}`])],
  [/^cargo add ([\w-]+)(?: --features ([\w,]+))?$/, ([, name, features]) => isOneOf(name, [identity.crate]) ?? haveFeatures(features)],
  [/^git clone (\S+)$/, ([, address]) => isOneOf(address, [identity.repository])],
  [/^cd ([\w-]+)$/, ([, folder]) => isOneOf(folder, [identity.repository.split('/').at(-1)])],
  [/^npm (start|run [\w:-]+)(?: -- .*)?$/, ([, name]) => isScript(name)],
  [/^npm ci --prefix ([\w/-]+)$/, ([, folder]) => (existsSync(join(root, folder, 'package-lock.json')) ? undefined : `no package-lock.json in ${folder}`)],
  [/^pip install -r ([\w/.]+)$/, ([, file]) => isInProject(file)],
  [/^export \w+=\S+$/, () => undefined],
  [/^(?:node|python) (examples\/[\w/.-]+)(?: .*)?$/, ([, file]) => isInProject(file)],
];

/** `curl` of the project's own files: they are taken from the checkout. */
const DOWNLOAD = new RegExp(`^curl -L(?: --create-dirs)? (?:-O|-o) "?(?:([^" ]+)"? "?)?${identity.repository}/raw/main/([^" ]+)"?$`);

/**
 * Divides a script. Returns the lines for the shell, and what was recognised instead; copies the files that it downloads into `folder`.
 * Throws for a line that is neither.
 */
export function divide(script, folder) {
  const lines = script.replaceAll('\\\n', ' ').split('\n').map(withoutComment).filter((line) => line !== '');
  const [run, recognised] = [[], []];
  for (const line of lines) {
    const checked = CHECKED.find(([pattern]) => pattern.test(line));
    const download = DOWNLOAD.exec(line);
    if (checked) {
      const [pattern, problem] = checked;
      const sentence = problem(pattern.exec(line));
      if (sentence) throw new Error(`${line}: ${sentence}`);
      recognised.push(line);
    } else if (download) {
      for (const [from, to] of copies(download)) {
        mkdirSync(dirname(join(folder, to)), { recursive: true });
        copyFileSync(join(root, from), join(folder, to));
      }
      recognised.push(line);
    } else if (RUN.includes(line.split(' ')[0])) {
      run.push(line);
    } else {
      throw new Error(`'${line}' is no command that the guide's test knows`);
    }
  }
  return { run, recognised };
}

/** The files of a download: from where in the checkout, to where. `[20-31]` counts, and `#1` is the number. */
function copies([, to, from]) {
  const [whole, first, last] = /\[(\d+)-(\d+)\]/.exec(from) ?? [];
  if (whole === undefined) return [[from, to ?? from.split('/').at(-1)]];
  return Array.from({ length: last - first + 1 }, (_, k) => {
    const number = String(Number(first) + k).padStart(first.length, '0');
    return [from.replace(whole, number), to.replace('#1', number)];
  });
}

function withoutComment(line) {
  return line.replace(/(?:^|\s+)# .*$/, '').trim();
}

function isOneOf(found, wanted) {
  return wanted.includes(found) ? undefined : `the name is ${wanted[0]}`;
}

function isInProject(file) {
  return existsSync(join(root, file)) ? undefined : `there is no ${file}`;
}

function isScript(command) {
  const name = command.replace('run ', '');
  return name in JSON.parse(projectText('package.json')).scripts ? undefined : `there is no script ${name}`;
}

function haveFeatures(names) {
  const known = /^\[features\]\n([\s\S]*?)\n\n/m.exec(readFileSync(join(root, 'Cargo.toml'), 'utf8'))[1];
  const missing = (names ?? '').split(',').filter((name) => name !== '' && !new RegExp(`^${name} =`, 'm').test(known));
  return missing.length === 0 ? undefined : `there is no feature ${missing[0]}`;
}
