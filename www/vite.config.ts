import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join, relative, sep } from 'node:path';
import { fileURLToPath } from 'node:url';

import { type HtmlTagDescriptor, type Plugin, defineConfig, normalizePath } from 'vite';
// @ts-expect-error: plain JavaScript, shared with the demonstration server
import { CONTENT_SECURITY_POLICY, HEADERS } from '../scripts/lib/policy.mjs';

const here = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** There is no such file: see {@link hostPage}. */
const HOST_PAGE = here('embed.html');

/** Adds the content security policy to the built pages. The development server needs more than it allows. */
function policy(): Plugin {
  let building = false;
  return {
    name: 'policy',
    configResolved: ({ command }) => void (building = command === 'build'),
    transformIndexHtml: (html) =>
      building ? html.replace('%POLICY%', CONTENT_SECURITY_POLICY) : html.replace(/\s*<meta http-equiv="Content-Security-Policy"[^>]*>/, ''),
  };
}

/** Builds and serves the example of a host page as if it were here: Vite takes pages from its root alone. */
function hostPage(): Plugin {
  const example = here('../examples/embed/');
  const page = normalizePath(HOST_PAGE);
  const html = (): string => readFileSync(join(example, 'embed.html'), 'utf8');
  return {
    name: 'host-page',
    enforce: 'pre',
    resolveId: (id) => (normalizePath(id) === page ? page : /^\.?\/embed\.(ts|css)(\?|$)/.test(id) ? join(example, id) : null),
    load: (id) => (id === page ? html() : null),
    configureServer: (server) => {
      server.middlewares.use('/embed.html', (_request, response, next) => {
        server.transformIndexHtml('/embed.html', html()).then((text) => response.setHeader('Content-Type', 'text/html').end(text), next);
      });
    },
  };
}

/** Leaves out the package's module for measurements, which the page never loads. */
function withoutMeasurements(): Plugin {
  return {
    name: 'without-measurements',
    apply: 'build',
    generateBundle(_options, bundle) {
      for (const name of Object.keys(bundle)) if (/veronese_points_bg.*\.wasm$/.test(name)) delete bundle[name];
    },
  };
}

/** The package brings what it needs of fflate. The page needs more of it, so both share the page's. */
function oneFflate(): Plugin {
  return {
    name: 'one-fflate',
    apply: 'build',
    enforce: 'pre',
    resolveId(id, importer) {
      return /^\.{1,2}\/fflate\.js$/.test(id) ? this.resolve('fflate', importer) : null;
    },
  };
}

/** Preloads, while the page is parsed, the WebAssembly module, and the typeface of the name so that it is there when the page is first drawn. */
function preload(): Plugin {
  return {
    name: 'preload',
    apply: 'build',
    transformIndexHtml: {
      order: 'post',
      handler: (_html, { bundle, path }) => {
        const names = path.endsWith('/index.html') ? Object.keys(bundle ?? {}) : [];
        const link = (name: string, as: string): HtmlTagDescriptor => ({
          tag: 'link',
          attrs: { rel: 'preload', as, href: `./${name}`, crossorigin: true },
          injectTo: 'head',
        });
        return names.flatMap((name) => (name.endsWith('.wasm') ? [link(name, 'fetch')] : name.endsWith('.woff2') ? [link(name, 'font')] : []));
      },
    },
  };
}

/** The page with the licences, and its style: only who asks for them loads them, so they are not kept for work without a network. */
const LICENCES = /^licences\./;

/** Makes that page, of the project's own licences and those of what it ships. */
function licences(): Plugin {
  const escaped = (text: string): string => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');
  const section = (name: string): string => {
    const text = escaped(readFileSync(here(`../${name}`), 'utf8'));
    const linked = text.replaceAll(/https?:\/\/[^\s"'<>)]*[^\s"'<>).,;]/g, '<a href="$&">$&</a>');
    // The first line break in a <pre> does not count.
    return `<h2>${name}</h2>\n<pre>\n${linked}</pre>\n`;
  };
  return {
    name: 'licences',
    apply: 'build',
    generateBundle() {
      const meta = '<meta charset="utf-8" /><meta name="viewport" content="width=device-width, initial-scale=1" />';
      const links = '<link rel="icon" type="image/svg+xml" href="./icon.svg" /><link rel="stylesheet" href="./licences.css" />';
      const body = ['THIRD-PARTY-NOTICES', 'LICENSE-MIT', 'LICENSE-APACHE'].map(section).join('');
      const head = `${meta}<title>Licences – Veronese</title>${links}`;
      const source = `<!doctype html>\n<html lang="en"><head>${head}</head><body><h1>Licences</h1>\n${body}</body></html>\n`;
      this.emitFile({ type: 'asset', fileName: 'licences.html', source });
    },
  };
}

/** Writes the service worker with the list of all files and a version that is a hash of them. */
function serviceWorker(): Plugin {
  return {
    name: 'service-worker',
    apply: 'build',
    writeBundle({ dir }) {
      if (dir === undefined) return;
      const paths = readdirSync(dir, { recursive: true, withFileTypes: true })
        .filter((entry) => entry.isFile() && entry.name !== 'service-worker.js' && !LICENCES.test(entry.name))
        .map((entry) => relative(dir, join(entry.parentPath, entry.name)).split(sep).join('/'))
        .sort();
      const hash = createHash('sha256');
      for (const path of paths) hash.update(path).update(readFileSync(join(dir, path)));
      const template = readFileSync(here('src/offline/service-worker.js'), 'utf8');
      const filled = template.replace('__FILES__', JSON.stringify(paths)).replace('__VERSION__', hash.digest('hex').slice(0, 16));
      writeFileSync(join(dir, 'service-worker.js'), filled);
    },
  };
}

export default defineConfig({
  // Relative URLs, so that the built page works in any folder of any host.
  base: './',
  plugins: [hostPage(), policy(), withoutMeasurements(), oneFflate(), preload(), licences(), serviceWorker()],
  worker: { format: 'es' },
  // The style sheets name the screens that they know.
  css: { transformer: 'lightningcss', lightningcss: { drafts: { customMedia: true } } },
  build: {
    target: 'es2023',
    // No data: URLs, because the content security policy allows scripts and WebAssembly from files only.
    assetsInlineLimit: 0,
    // What is loaded later needs little besides what is there: the list of that would be larger than what it saves.
    modulePreload: { polyfill: false, resolveDependencies: (_file, needed, { hostType }) => needed.filter((name) => hostType === 'html' || name.endsWith('.css')) },
    rolldownOptions: { input: [here('index.html'), HOST_PAGE] },
  },
  // Not pre-bundled, because the package finds its worker and module by import.meta.url.
  optimizeDeps: { exclude: ['veronese'] },
  preview: { strictPort: true, headers: HEADERS },
});
