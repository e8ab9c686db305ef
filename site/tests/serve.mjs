// Serves out/site twice, as a plain file server would: at / and at /a/b/.
//
// node site/tests/serve.mjs PORT

import { mkdirSync, mkdtempSync, symlinkSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { serve } from '../../scripts/lib/static-server.mjs';

const SITE = fileURLToPath(new URL('../../out/site', import.meta.url));
const HOST = '127.0.0.1';
const port = Number(process.argv[2]);

await serve(SITE, { host: HOST, port, headers: {} });
await serve(nested('a/b'), { host: HOST, port: port + 1, headers: {} });

/** A folder that has the site at `path`. */
function nested(path) {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-site-'));
  const place = join(folder, path);
  mkdirSync(dirname(place), { recursive: true });
  symlinkSync(SITE, place);
  return folder;
}
