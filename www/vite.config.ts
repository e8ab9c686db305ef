import { defineConfig } from 'vite';

export default defineConfig({
  // Relative addresses: the built page works in any folder of any host.
  base: './',
  worker: { format: 'es' },
  build: {
    target: 'es2023',
    // No data: addresses: the content security policy lets scripts and WebAssembly come from files only.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
  },
  // The package is part of this project and finds its worker and module by import.meta.url: leave it as it is.
  optimizeDeps: { exclude: ['veronese'] },
  preview: { strictPort: true },
});
