// Serves out/site as a plain file server would: at / on PORT, and at /out/site/ on the next port.
//
// node site/tests/serve.mjs PORT

import { fileURLToPath } from 'node:url';

import { serve } from '../../scripts/lib/static-server.mjs';

const PROJECT = fileURLToPath(new URL('../..', import.meta.url));
const options = { host: '127.0.0.1', headers: {} };
const port = Number(process.argv[2]);

await serve(`${PROJECT}/out/site`, { ...options, port });
await serve(PROJECT, { ...options, port: port + 1 });
