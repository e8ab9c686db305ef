// The programs of experiments: Rust, compiled with all that the published crate leaves out, so that they share what is compiled.

import { readFileSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { findOpenCv, runOnAll } from './opencv.mjs';
import { root } from './project.mjs';
import { Stop, run } from './run.mjs';
import { checkRust } from './rust.mjs';

const CARGO = ['run', '--quiet', '--release', '--locked', '--package', 'experiments', '--features', 'ablation,plot', '--example'];

let said = false;

/** Starts a program; says once that cargo may build it first. */
async function start(name, args, options) {
  await checkRust();
  if (!said) console.error('Building the program if it has changed (some minutes when everything is new) …');
  said = true;
  return run('cargo', [...CARGO, name, '--', ...args], options);
}

/** Runs a program and returns its exit code. */
export async function experiment(name, args) {
  return (await start(name, args)).code;
}

/** The same, but a failure stops the command. */
export async function measured(name, args) {
  const code = await experiment(name, args);
  if (code !== 0) throw new Stop(`The program ${name} ended with code ${code}.`);
}

/** Runs a step that is measured by itself, `--STEP` among the arguments, and returns what it wrote to STEP.json in `out`. */
export async function measuredApart(name, step, args, out) {
  await measured(name, [step, ...args.filter((arg) => arg !== `--${step}`)]);
  return JSON.parse(readFileSync(join(out, `${step}.json`), 'utf8'));
}

/** Whether help is asked for. */
export function wantsHelp(args) {
  return args.includes('--help') || args.includes('-h');
}

/** The value of an option, if it is there. */
export function valueOf(args, option) {
  const place = args.indexOf(option);
  return place < 0 ? undefined : args[place + 1];
}

/** The folder of the results. */
export function outOf(args, usual) {
  return resolve(root, valueOf(args, '--out') ?? usual);
}

/**
 * Has a program write its cases, and runs a Python program with OpenCV on each, with the arguments that `argumentsOf` gives for its name and
 * folder. What is in `old` folders of earlier runs is removed.
 */
export async function runPeers(name, args, { out, old, program, argumentsOf }) {
  for (const folder of old) rmSync(join(out, folder), { recursive: true, force: true });
  const { code, text, stdout } = await start(name, ['frames', ...args], { output: 'collect' });
  if (code !== 0) throw new Stop(text.trim());
  const cases = stdout
    .split('\n')
    .filter(Boolean)
    .map((line) => line.split('\t'));
  const python = cases.length > 0 && (await findOpenCv());
  if (python) await runOnAll(python, program, cases, argumentsOf);
}
