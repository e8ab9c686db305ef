import { fileURLToPath } from 'node:url';

import { defineConfig } from '@playwright/test';

const PORT = Number(process.env.VERONESE_TEST_PORT ?? 4857);

export default defineConfig({
  testDir: '.',
  testMatch: '**/*.spec.mjs',
  testIgnore: 'browsers/**',
  outputDir: fileURLToPath(new URL('../../out/site-test-results', import.meta.url)),
  fullyParallel: true,
  workers: 2,
  // Only a failure takes so long: cargo may have most of the machine.
  timeout: 240_000,
  expect: { timeout: 60_000 },
  forbidOnly: process.env.CI !== undefined,
  reporter: [['list']],
  use: {
    baseURL: `http://127.0.0.1:${PORT}/`,
    viewport: { width: 1280, height: 860 },
    launchOptions: {
      executablePath: process.env.VERONESE_CHROMIUM ?? '/usr/bin/chromium',
      args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-default-apps', '--disable-sync', '--no-first-run', '--no-pings'],
    },
  },
  webServer: {
    command: `node ${fileURLToPath(new URL('serve.mjs', import.meta.url))} ${PORT}`,
    url: `http://127.0.0.1:${PORT}/`,
    reuseExistingServer: false,
  },
});
