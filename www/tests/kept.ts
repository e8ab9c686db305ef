//! A page for each test that is as good as new, in a browser context that is kept: a new one costs three times as much as all else of a start.
//! All that a test leaves behind is undone: stored data, routes, listeners, scripts, emulation, permissions, other pages.

import { type Browser, type BrowserContext, type CDPSession, type Page, test as base } from '@playwright/test';

interface Kept {
  readonly context: BrowserContext;
  readonly page: Page;
}

/** Tests that leave something behind in the context that {@link undone} does not know have one of their own: `test.use({ fresh: true })`. */
interface Options {
  fresh: boolean;
}

/** Those of this process, which has one browser: by what a context cannot change. */
const keptContexts = new Map<string, Kept>();

/** Playwright's test, with `context` and `page` of a context that is kept over tests and files. */
export const test = base.extend<Options>({
  fresh: [false, { option: true }],
  context: async ({ browser, fresh, baseURL, viewport, colorScheme, hasTouch, isMobile, deviceScaleFactor, serviceWorkers }, use) => {
    if (fresh || serviceWorkers !== 'block') {
      const context = await browser.newContext();
      await context.newPage();
      await use(context);
      return context.close();
    }
    const kind = JSON.stringify({ hasTouch, isMobile, deviceScaleFactor });
    const kept = keptContexts.get(kind) ?? (await opened(browser));
    keptContexts.delete(kind); // whatever fails from here on, nobody gets it again
    if (viewport) await kept.page.setViewportSize(viewport);
    await kept.page.emulateMedia({ colorScheme });
    const [scripts, sessions] = recorded(kept);
    await use(kept.context);
    await Promise.all(scripts.splice(0).map((script) => script.dispose()));
    await Promise.all(sessions.splice(0).map((session) => session.detach().catch(() => undefined))); // with their page, some have ended
    if (kept.page.isClosed()) return kept.context.close();
    await undone(kept, new URL(baseURL!).origin);
    keptContexts.set(kind, kept);
  },
  page: async ({ context }, use) => {
    const [page] = context.pages();
    if (process.env.VERONESE_STRESS === 'slow-page') await slowDown(context, page!);
    await use(page!);
    page!.removeAllListeners();
  },
});

/** The page is on a slow machine, and its scripts come late, by a slow line: `npm test -- --stress`. */
async function slowDown(context: BrowserContext, page: Page): Promise<void> {
  const devtools = await context.newCDPSession(page);
  await devtools.send('Emulation.setCPUThrottlingRate', { rate: 6 });
  devtools.on('Fetch.requestPaused', ({ requestId }) => {
    setTimeout(() => void devtools.send('Fetch.continueRequest', { requestId }).catch(() => undefined), 1000);
  });
  await devtools.send('Fetch.enable', { patterns: [{ urlPattern: '*/assets/*.js' }] });
}

async function opened(browser: Browser): Promise<Kept> {
  const context = await browser.newContext();
  return { context, page: await context.newPage() };
}

/** The scripts that the page and its context are given, and the sessions of the protocol, from now on. */
function recorded({ context, page }: Kept): [{ dispose(): Promise<void> }[], CDPSession[]] {
  const scripts: { dispose(): Promise<void> }[] = [];
  const sessions: CDPSession[] = [];
  for (const one of [context, page]) {
    const add = Object.getPrototypeOf(one).addInitScript as (...given: unknown[]) => ReturnType<Page['addInitScript']>;
    one.addInitScript = async (...given: unknown[]) => {
      const script = await add.apply(one, given);
      scripts.push(script);
      return script;
    };
  }
  const open = Object.getPrototypeOf(context).newCDPSession as BrowserContext['newCDPSession'];
  context.newCDPSession = async (of) => {
    const session = await open.call(context, of);
    sessions.push(session);
    return session;
  };
  return [scripts, sessions];
}

async function undone({ context, page }: Kept, origin: string): Promise<void> {
  context.removeAllListeners();
  page.removeAllListeners();
  for (const other of context.pages()) if (other !== page) await other.close();
  await page.evaluate(() => sessionStorage.clear()).catch(() => undefined); // about:blank has none
  // Its workers end with it. A question whether to leave is answered with yes where nobody listens.
  await page.goto('about:blank');
  // Requests that were on their way end with the page, whatever their routes still do.
  await Promise.all([context.unrouteAll({ behavior: 'ignoreErrors' }), page.unrouteAll({ behavior: 'ignoreErrors' }), context.clearPermissions(), context.setOffline(false)]);
  await page.emulateMedia({ media: null, colorScheme: null, reducedMotion: null, forcedColors: null, contrast: null });
  await page.mouse.move(-1, -1);
  const devtools = await context.newCDPSession(page);
  await devtools.send('Storage.clearDataForOrigin', { origin, storageTypes: 'all' });
  await devtools.detach();
}
