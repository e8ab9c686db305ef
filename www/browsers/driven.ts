//! One browser, driven through WebDriver: its driver is started, and ended with all that it started.

import { type ChildProcess, spawn } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm } from 'node:fs/promises';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

import { Builder, By, type WebDriver, type WebElement } from 'selenium-webdriver';

/** As `scripts/lib/browsers.mjs` finds it: with the command line of its driver, or with the reason why it cannot be driven. */
export type Found = { readonly name: string } & ({ readonly program: string; readonly driver: readonly [string, ...string[]]; readonly problem?: never } | { readonly problem: string });

/** How long a page may take for one step, milliseconds. */
const PATIENCE = 60_000;

export const BROWSERS: readonly Found[] = JSON.parse(
  process.env.VERONESE_BROWSERS ?? '[{"name": "No browser", "problem": "The browsers are found by `npm run soak -- browsers`: run that."}]',
);

/** A browser that is open. */
export class Driven {
  private constructor(
    readonly driver: WebDriver,
    readonly program: ChildProcess,
    readonly home: string,
  ) {}

  static async open(found: Found): Promise<Driven> {
    if (found.problem !== undefined) throw new Error(found.problem);
    // Profiles, downloads and settings go where nobody else's are.
    const home = await mkdtemp(join(tmpdir(), 'veronese-browser-'));
    const port = await freePort();
    const [command, ...args] = found.driver;
    const root = process.getuid?.() === 0;
    const program = spawn(command, [...args, `--port=${port}`], {
      // A group of its own: the programs that a driver starts end with it.
      detached: true,
      stdio: 'ignore',
      env: { ...process.env, HOME: home, XDG_CONFIG_HOME: home, XDG_DATA_HOME: home, XDG_CACHE_HOME: home, XDG_DOWNLOAD_DIR: home, ...(root && { WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS: '1' }) },
    });
    const failed = new Promise<never>((_, reject) => program.once('error', reject));
    try {
      const address = `http://127.0.0.1:${port}`;
      await Promise.race([answering(address, program), failed]);
      return new Driven(await new Builder().usingServer(address).withCapabilities(capabilities(found.name, found.program, home)).build(), program, home);
    } catch (error) {
      await ended(program, home);
      throw error;
    }
  }

  async close(): Promise<void> {
    await this.driver.quit().catch(() => undefined);
    await ended(this.program, this.home);
  }

  find(selector: string): WebElement {
    return this.driver.findElement(By.css(selector));
  }

  /** Waits until a condition on the page holds. */
  async until(what: string, condition: () => boolean | Promise<boolean>): Promise<void> {
    await this.driver.wait(condition, PATIENCE, `waited for ${what}`, 50);
  }

  /** Waits until an attribute has this value. */
  untilAttribute(selector: string, name: string, value: string): Promise<void> {
    return this.until(`${selector} with ${name} "${value}"`, async () => (await this.find(selector).getAttribute(name)) === value);
  }

  /** Waits until the text of an element has this in it. */
  untilText(selector: string, text: string): Promise<void> {
    return this.until(`"${text}" in ${selector}`, async () => (await this.find(selector).getProperty('textContent')).includes(text));
  }

  /** The RGBA bytes of a canvas. */
  async pixelsOf(selector: string): Promise<Uint8Array> {
    const base64 = await this.driver.executeScript<string>(
      `const canvas = document.querySelector(arguments[0]);
      const copy = document.createElement('canvas');
      copy.width = canvas.width;
      copy.height = canvas.height;
      const context = copy.getContext('2d', { willReadFrequently: true });
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
      let binary = '';
      for (let i = 0; i < data.length; i += 0x8000) binary += String.fromCharCode(...data.subarray(i, i + 0x8000));
      return btoa(binary);`,
      selector,
    );
    return new Uint8Array(Buffer.from(base64, 'base64'));
  }

  /** The bytes of a file that the page saves, as soon as it is whole. */
  async downloaded(name: string): Promise<Buffer> {
    let size = -1;
    await this.until(`the download of ${name}`, async () => {
      const path = (await readdir(this.home, { recursive: true })).find((path) => path.endsWith(name));
      const before = size;
      size = path === undefined ? -1 : (await readFile(join(this.home, path))).length;
      if (size === before) await sleep(200);
      return size > 0 && size === before && !(await readdir(this.home, { recursive: true })).some((path) => /\.(part|crdownload|wkdownload)$/.test(path));
    });
    return readFile(join(this.home, (await readdir(this.home, { recursive: true })).find((path) => path.endsWith(name))!));
  }
}

function capabilities(name: string, binary: string, downloads: string): Record<string, unknown> {
  if (name === 'Chromium') {
    const args = ['--headless=new', '--no-sandbox', '--disable-background-networking', '--disable-component-update', '--no-first-run', '--window-size=1280,860'];
    return { browserName: 'chrome', 'goog:chromeOptions': { binary, args, prefs: { 'download.default_directory': downloads } } };
  }
  if (name === 'Firefox') {
    const prefs = { 'browser.download.dir': downloads, 'browser.download.folderList': 2, 'app.update.enabled': false };
    return { browserName: 'firefox', 'moz:firefoxOptions': { binary, args: ['-headless'], prefs } };
  }
  return { browserName: 'MiniBrowser', 'webkitgtk:browserOptions': { binary, args: ['--automation'] } };
}

async function freePort(): Promise<number> {
  const server = createServer();
  await new Promise<void>((resolve) => void server.listen(0, '127.0.0.1', resolve));
  const address = server.address();
  await new Promise((resolve) => server.close(resolve));
  if (address === null || typeof address === 'string') throw new Error('no port');
  return address.port;
}

async function answering(address: string, program: ChildProcess): Promise<void> {
  const since = Date.now();
  while (!(await fetch(`${address}/status`).then(({ ok }) => ok, () => false))) {
    if (program.exitCode !== null) throw new Error(`${program.spawnfile} ended with code ${program.exitCode}`);
    if (Date.now() - since > PATIENCE) throw new Error(`${program.spawnfile} did not answer`);
    await sleep(100);
  }
}

async function ended(program: ChildProcess, home: string): Promise<void> {
  if (program.pid !== undefined && program.exitCode === null) {
    const closed = new Promise((resolve) => program.once('close', resolve));
    process.kill(-program.pid, 'SIGTERM');
    await closed;
  }
  // A browser may still be writing its profile.
  await rm(home, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
}
