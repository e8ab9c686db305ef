import { defineConfig } from '@playwright/test';

import site from './playwright.config.mjs';

/** The explainer in several browsers, by WebDriver; scripts/lib/browsers.mjs finds them and starts this. */
export default defineConfig({ ...site, testDir: 'browsers', testIgnore: [], timeout: 300_000 });
