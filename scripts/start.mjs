// npm start: prepares, builds, segments the bundled pair and serves the page.

import { join, relative } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { parseArgs } from 'node:util';

import { buildPackage, buildPage } from './lib/builds.mjs';
import { describe } from './lib/describe.mjs';
import { nextSteps } from './lib/next-steps.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { Stop, command, interruption, run } from './lib/run.mjs';
import { serve } from './lib/static-server.mjs';

const SAMPLE = join(root, 'www', 'public', 'samples', 'intel-two-cars');
const OUT = join(root, 'out', 'demo');
const USAGE = `npm start [-- OPTIONS]: segments the bundled pair of frames and serves the page.

  --no-serve      stop before serving
  --port N        serve on port N (default: 4173, or the next free port)
  --host ADDRESS  listen on ADDRESS (default: 127.0.0.1, this computer only)`;

await command(async (args) => {
  const options = parse(args);
  if (typeof options === 'number') return options;
  await prepare();
  await buildPackage();
  await segmentSample();
  await buildPage();
  if (options.serve) await serveUntilInterrupted(options);
  else console.log(nextSteps());
  return 0;
});

/** The options, or an exit code if the command ends at once. */
function parse(args) {
  const wrong = (sentence) => {
    console.error(`${sentence}\n\n${USAGE}`);
    return 2;
  };
  let values;
  try {
    const flag = { type: 'boolean' };
    const text = { type: 'string' };
    ({ values } = parseArgs({ args, options: { 'no-serve': flag, help: flag, port: text, host: text } }));
  } catch (error) {
    return wrong(error.message);
  }
  if (values.help) {
    console.log(USAGE);
    return 0;
  }
  const port = values.port === undefined ? undefined : Number(values.port);
  if (port !== undefined && !(/^\d+$/.test(values.port) && port <= 65535)) {
    return wrong(`--port takes a whole number from 0 to 65535, not '${values.port}'.`);
  }
  return { serve: !values['no-serve'], port, host: values.host ?? '127.0.0.1' };
}

/** Segments the real pair with the command line tool, as a user would. */
async function segmentSample() {
  const frames = ['first.png', 'second.png'].map((name) => join(SAMPLE, name));
  // What another version has written there is replaced.
  const args = ['pkg/bin/veronese.js', 'pair', ...frames, '--out', OUT, '--overlay', '--force'].map((arg) => relativeToRoot(arg));
  console.log(`\nnode ${args.join(' ')}`);
  const { code, text, stdout } = await run(process.execPath, args, { output: 'collect' });
  if (code !== 0) {
    process.stderr.write(text);
    throw new Stop('The bundled pair could not be segmented.');
  }
  console.log(describe(JSON.parse(stdout)));
  console.log(`Masks and overlay are in ${relativeToRoot(OUT)}/.\n`);
}

function relativeToRoot(path) {
  return path.startsWith(root) ? relative(root, path) : path;
}

async function serveUntilInterrupted({ port, host }) {
  const server = await serve(join(root, 'www', 'dist'), { port, host });
  const ended = interruption();
  console.log(nextSteps({ host, port: server.address().port }));
  await ended;
  server.close();
  server.closeAllConnections();
  // npm forwards the signal that the terminal has already sent. Stay alive to receive it; otherwise it ends this process with an error.
  await sleep(200);
}
