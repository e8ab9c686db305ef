// The lines of a page's shell commands: those that install or download are checked and not run, the others run in a shell.

import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

import { projectText, root } from '../../../scripts/lib/project.mjs';
import identity from '../../data/identity.mjs';

const { version } = JSON.parse(projectText('pkg/package.json'));

/** The programs that the shell may run. */
const RUN = ['cat', 'cp', 'echo', 'find', 'head', 'ls', 'mkdir', 'node', 'npx', 'python', 'wc'];

/** Each pattern of a line that is not run, and what is checked of it. */
const CHECKED = [
  [/^npm install ([\w@/.-]+)(?: vite)?$/, ([, name]) => isOneOf(name, [identity.npm, `${identity.npm}@${version}`])],
  [/^pip install ([\w=.]+)$/, ([, name]) => isOneOf(name, [identity.python, `${identity.python}==${version}`])],
  [/^cargo add ([\w-]+)(?: --features ([\w,]+))?$/, ([, name, features]) => isOneOf(name, [identity.crate]) ?? haveFeatures(features)],
  [/^git clone (\S+)$/, ([, address]) => isOneOf(address, [identity.repository])],
  [/^cd ([\w-]+)$/, ([, folder]) => isOneOf(folder, [identity.repository.split('/').at(-1)])],
  [/^npm (start|run [\w:-]+)(?: -- .*)?$/, ([, name]) => isScript(name)],
  [/^npm ci --prefix ([\w/-]+)$/, ([, folder]) => (existsSync(join(root, folder, 'package-lock.json')) ? undefined : `no package-lock.json in ${folder}`)],
  [/^pip install -r ([\w/.]+)$/, ([, file]) => isInProject(file)],
  [/^export \w+=\S+$/, () => undefined],
  // The reader's folder has these files; of several, `[20-31]`, the first is asked for.
  [new RegExp(`^curl -L .*"?${identity.repository}/raw/main/([^" ]+)"?$`), ([, file]) => isInProject(file.replace(/\[(\d+)-\d+\]/, '$1'))],
  [/^(?:node|python) (examples\/[\w/.-]+)(?: .*)?$/, ([, file]) => isInProject(file)],
];

/** Divides a script. Returns the lines for the shell, and those that were recognised instead. Throws for a line that is neither. */
export function divide(script) {
  const lines = script.replaceAll('\\\n', ' ').split('\n').map(withoutComment).filter((line) => line !== '');
  const [run, recognised] = [[], []];
  for (const line of lines) {
    const checked = CHECKED.find(([pattern]) => pattern.test(line));
    if (checked) {
      const [pattern, problem] = checked;
      const sentence = problem(pattern.exec(line));
      if (sentence) throw new Error(`${line}: ${sentence}`);
      recognised.push(line);
    } else if (RUN.includes(line.split(' ')[0])) {
      run.push(line);
    } else {
      throw new Error(`'${line}' is no command that the guide's test knows`);
    }
  }
  return { run, recognised };
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
