// Pairs in a page of headless Chromium, through a pool that stays. The reference result is that of Node.

import { segmentPair } from '../../../pkg/dist/node.js';
import { browserMemory } from '../browser-memory.mjs';
import { openBrowser } from '../launch-chromium.mjs';
import { root } from '../project.mjs';
import { flatMemory, hashOf, sameAsBefore } from './checks.mjs';
import { OPTIONS, REFERENCE, pairOf } from './frames.mjs';

const BATCH = 25;

/** Yields how many are done after each batch. */
export async function* page({ from, total, references, jobs, setup: { chromium } }) {
  const { first, second } = pairOf(REFERENCE);
  sameAsBefore(references, 'pairs', hashOf(await segmentPair(first, second, OPTIONS)));
  const { browser, address, close } = await openBrowser(chromium, root, {});
  const memory = flatMemory();
  try {
    const session = await browser.newBrowserCDPSession();
    const opened = await browser.newPage();
    await opened.goto(`${address}scripts/lib/soak/page.html`, { waitUntil: 'load' });
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
    await close();
  }
}
