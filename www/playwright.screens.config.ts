import { defineConfig } from '@playwright/test';

import pages from './playwright.config.js';

/** Screenshots of the page; `npm run soak -- screens` starts this. */
export default defineConfig({ ...pages, testDir: 'screens' });
