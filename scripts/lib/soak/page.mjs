// Pairs in a page of headless Chromium, through a pool that stays. The reference result is that of Node.

import { segmentPair } from '../../../pkg/dist/node.js';
import { browserMemory } from '../browser-memory.mjs';
import { launchChromium } from '../launch-chromium.mjs';
import { root } from '../project.mjs';
import { Stop } from '../run.mjs';
import { serve } from '../static-server.mjs';
import { flatMemory, hashOf, sameAsBefore } from './checks.mjs';
import { OPTIONS, REFERENCE, pairOf } from './frames.mjs';

const BATCH = 25;
const HOST = '127.0.0.1';

/** Yields how many are done after each batch. */
export async function* page({ from, total, references, jobs, setup: { chromium } }) {
  if (chromium.problem) throw new Stop(chromium.problem);
  const { first, second } = pairOf(REFERENCE);
  sameAsBefore(references, 'pairs', hashOf(await segmentPair(first, second, OPTIONS)));
  const server = await serve(root, { host: HOST, headers: {} });
  const browser = await launchChromium(chromium.path);
  const memory = flatMemory();
  try {
    const session = await browser.newBrowserCDPSession();
    const opened = await browser.newPage();
    await opened.goto(`http://${HOST}:${server.address().port}/scripts/lib/soak/page.html`, { waitUntil: 'load' });
    await opened.waitForFunction(() => globalThis.soak !== undefined);
    for (let done = from; done < total; ) {
      const count = Math.min(BATCH, total - done);
      const { answered, problem, labels, motions } = await opened.evaluate((asked) => globalThis.soak(asked), { start: done, count, jobs });
      if (problem) throw new Error(problem);
      if (answered !== count) throw new Error(`${answered} of ${count} pairs were answered`);
      sameAsBefore(references, 'pairs', hashOf({ labels: Buffer.from(labels, 'base64'), motions }));
      done += count;
      yield { done, note: memory(await browserMemory(session)) };
    }
  } finally {
    await browser.close();
    server.close();
    server.closeAllConnections();
  }
}
