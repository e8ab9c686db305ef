// Loads a page of the guide in Chromium, by Vite where the page has the name of a file. A page that asks for files is given the frames. What
// it writes to the console is what it prints.

import { readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { setTimeout } from 'node:timers/promises';

import { chromium } from '@playwright/test';
import { createServer } from 'vite';
import { prepareChromium } from '../../../scripts/lib/chromium.mjs';
import { root } from '../../../scripts/lib/project.mjs';
import { serve } from '../../../scripts/lib/static-server.mjs';
import { matches } from './pages.mjs';

const CDN = 'https://cdn.jsdelivr.net';
const LONGEST_WAIT = 90_000;
const ARGS = ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run', '--no-pings'];

let started;

/** The browser of all pages, or why there is none. */
function browser() {
  started ??= prepareChromium().then(async ({ path, problem }) => (problem ? { problem } : { browser: await chromium.launch({ executablePath: path, args: ARGS }) }));
  return started;
}

export async function closeBrowser() {
  const { browser } = (await started) ?? {};
  await browser?.close();
}

export async function showPage({ t, folder, block }) {
  if (!block.output) throw new Error('a block of HTML needs a block of what it prints');
  const { browser: running, problem } = await browser();
  if (problem) return { skip: problem };
  const code = block.code.includes(CDN) ? await fromAnotherOrigin(t, block.code) : block.code;
  const file = block.file ?? 'example.html';
  writeFileSync(join(folder, file), code);
  const page = await running.newPage();
  t.after(() => page.close());
  const [lines, complaints] = [[], []];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => {
    const isIcon = message.location().url.endsWith('/favicon.ico');
    if (message.type() === 'log') lines.push(message.text());
    else if (message.type() === 'error' && !isIcon) complaints.push(message.text());
  });
  await page.goto(`${await (block.file ? byVite(t, folder) : address(t, folder))}${file}`);
  const chooser = page.locator('input[type=file]');
  if ((await chooser.count()) > 0) await chooser.setInputFiles(readdirSync(join(folder, 'frames')).sort().map((name) => join(folder, 'frames', name)));
  // Of a page whose output is not written yet, nobody knows how many lines there will be; with `…` it ends with the last one that is said.
  const said = block.output.code.trimEnd().split('\n');
  const isWhole = () => (said.includes('…') ? matches(lines.join('\n'), block.output.code) : lines.length >= said.length);
  const isUnknown = block.output.code === '';
  const end = Date.now() + (isUnknown ? LONGEST_WAIT / 4 : LONGEST_WAIT);
  while ((isUnknown || !isWhole()) && complaints.length === 0 && Date.now() < end) await setTimeout(50);
  await setTimeout(200); // A line too many is an error too.
  if (complaints.length > 0) throw new Error(`the browser said:\n${complaints.join('\n')}`);
  return `${lines.join('\n')}\n`;
}

/** The page with the package of this checkout on a server of its own, in the place of the CDN's. */
async function fromAnotherOrigin(t, code) {
  const far = await address(t, join(root, 'pkg'), { 'Access-Control-Allow-Origin': '*' });
  return code.replaceAll(/https:\/\/cdn\.jsdelivr\.net\/npm\/veronese@[\d.]+\//g, far).replaceAll(CDN, new URL(far).origin);
}

/** The address of Vite's development server, as `npx vite` starts it. */
async function byVite(t, root) {
  const server = await createServer({ root, configFile: false, logLevel: 'error', clearScreen: false, server: { host: '127.0.0.1', port: 0, hmr: false, watch: null } });
  t.after(() => server.close());
  await server.listen();
  return `http://127.0.0.1:${server.httpServer.address().port}/`;
}

async function address(t, folder, headers = {}) {
  const server = await serve(folder, { port: 0, host: '127.0.0.1', headers });
  t.after(() => {
    server.close();
    server.closeAllConnections();
  });
  return `http://127.0.0.1:${server.address().port}/`;
}
