// A server started by a command: its options, a line with its address, its end.

import { parseArgs } from 'node:util';

const text = { type: 'string' };
const list = { type: 'string', multiple: true };
const OPTIONS = { port: text, host: text, 'known-as': list, jobs: text, tasks: text, pixels: text };

/** `start` takes the options as numbers and texts; `lists` and `limits` are those of one server alone. */
export async function run(title, start, { port, lists = [], limits = [] }) {
  try {
    const own = [...lists.map((name) => [name, list]), ...limits.map((name) => [name, text])];
    const { values } = parseArgs({ options: { ...OPTIONS, ...Object.fromEntries(own) } });
    const numbers = Object.fromEntries(['port', 'jobs', 'tasks', 'pixels', ...limits].map((name) => [name, number(name, values[name])]));
    const server = await start({ ...values, ...numbers, port: numbers.port ?? port, knownAs: values['known-as'] });
    console.log(`${title} at ${server.address}`);
    for (const signal of ['SIGINT', 'SIGTERM']) process.once(signal, () => server.close());
  } catch (error) {
    console.error(error.message);
    process.exitCode = 1;
  }
}

function number(name, value) {
  if (value === undefined) return undefined;
  if (!/^\d+$/.test(value) || (name !== 'port' && Number(value) === 0)) throw new Error(`--${name} takes a whole number, not '${value}'`);
  return Number(value);
}
