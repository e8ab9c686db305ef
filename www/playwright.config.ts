import { defineConfig } from '@playwright/test';

/** `npm test -- --stress`: a slow page, or tests that are slow and find the page ahead of them. */
const stress = process.env.VERONESE_STRESS;
const PORT = Number(process.env.VERONESE_TEST_PORT ?? 4817);

export default defineConfig({
  testDir: 'tests',
  outputDir: 'test-results',
  fullyParallel: true,
  // One more than cores: each waits for its page at times.
  workers: 3,
  // Only a failure takes so long: cargo may have most of the machine.
  timeout: stress === undefined ? 240_000 : 900_000,
  expect: { timeout: 60_000 },
  forbidOnly: process.env.CI !== undefined,
  // Sweeps over many settings, and what measures more than it tests: npm run soak.
  ...(process.env.VERONESE_SOAK === undefined && { grepInvert: /@soak/ }),
  reporter: [['list']],
  use: {
    baseURL: `http://127.0.0.1:${PORT}/`,
    // Tests delay and replace files, which a service worker would have cached. The test of the service worker allows it.
    serviceWorkers: 'block',
    viewport: { width: 1280, height: 860 },
    launchOptions: {
      ...(stress === 'slow-test' && { slowMo: 150 }),
      executablePath: process.env.VERONESE_CHROMIUM ?? '/usr/bin/chromium',
      args: [
        '--no-sandbox',
        // A fake camera.
        '--use-fake-device-for-media-stream',
        '--use-fake-ui-for-media-stream',
        // No requests by the browser itself.
        '--disable-background-networking',
        '--disable-component-update',
        '--disable-default-apps',
        '--disable-domain-reliability',
        '--disable-sync',
        '--no-first-run',
        '--no-pings',
        // Nothing is drawn of the browser's own windows, and no process waits for a second page in them.
        '--disable-features=PreloadTopChromeWebUI,SpareRendererForSitePerProcess',
      ],
    },
  },
  webServer: {
    command: `npm run --silent preview -- --host 127.0.0.1 --port ${PORT}`,
    url: `http://127.0.0.1:${PORT}/`,
    reuseExistingServer: false,
  },
});
