import { defineConfig } from '@playwright/test';

import browsers from './playwright.browsers.config.js';

/** The package in several browsers, by WebDriver; `npm run same-bits` finds them, serves the package and starts this. */
const { webServer: _, ...rest } = browsers;
export default defineConfig({ ...rest, testDir: 'same-bits', timeout: 1_800_000, workers: 1 });
