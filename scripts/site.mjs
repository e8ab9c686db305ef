// npm run site: makes the whole site in out/site: pages, the app, references and the search. Links are relative, so that it works in any
// folder of any server. Options:
//   --serve [--port N]   serves it as well (4180)
//   --pages              only what stands in site/: the app and the references stay as they are

import { parseArgs } from 'node:util';

import { Stop, command } from './lib/run.mjs';
import { OUT, makeSite } from './lib/site.mjs';
import { serve } from './lib/static-server.mjs';

const HOST = '127.0.0.1';

await command(async (args) => {
  const { serves, port, onlyPages } = options(args);
  await makeSite({ onlyPages });
  console.log('out/site/index.html');
  if (!serves) return;
  await serve(OUT, { host: HOST, port, headers: {} });
  console.log(`http://${HOST}:${port}/`);
  await new Promise(() => {});
});

function options(args) {
  try {
    const { values } = parseArgs({
      args,
      options: {
        serve: { type: 'boolean', default: false },
        port: { type: 'string', default: '4180' },
        pages: { type: 'boolean', default: false },
      },
    });
    const port = Number(values.port);
    if (!Number.isInteger(port) || port < 1 || port > 65535)
      throw new Stop(`--port must be a whole number from 1 to 65535, not ${values.port}.`);
    return { serves: values.serve, port, onlyPages: values.pages };
  } catch (thrown) {
    throw thrown instanceof Stop ? thrown : new Stop(thrown.message);
  }
}
