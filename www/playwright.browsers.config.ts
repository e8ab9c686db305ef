import { defineConfig } from '@playwright/test';

import pages from './playwright.config.js';

/** The page in several browsers, by WebDriver; `npm run soak -- browsers` finds them and starts this. */
export default defineConfig({ ...pages, testDir: 'browsers', timeout: 180_000 });
