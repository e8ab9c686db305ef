// Makes the site's pages. scripts/site.mjs runs it, and puts the page, the package and the references beside them.
//
// Eleventy, because it makes plain HTML of Markdown and adds no script: a page weighs what it says. Formulas are set as MathML and code is
// coloured while the site is built. All links are relative, so that the site works in any folder of any server.

import { dirname, posix } from 'node:path';

import highlighting from '@11ty/eleventy-plugin-syntaxhighlight';
import katex from '@vscode/markdown-it-katex';
import anchors from 'markdown-it-anchor';

export default function configure(eleventy) {
  eleventy.addPlugin(highlighting);
  let library;
  eleventy.amendLibrary('md', (markdown) => {
    library = markdown;
    markdown.set({ typographer: false });
    markdown.use(katex.default ?? katex, { output: 'mathml', throwOnError: true, strict: 'error' });
    markdown.use(anchors, { level: [2, 3], slugify, permalink: anchors.permalink.headerLink({ safariReaderFix: true }), tabIndex: false });
  });
  eleventy.addPassthroughCopy({ styles: 'styles', 'pages/guide/images': 'guide/images' });
  eleventy.addTransform('relative', function relative(content) {
    const { outputPath, url } = this.page;
    return outputPath?.endsWith('.html') ? withRelativeLinks(content, url) : content;
  });
  eleventy.addCollection('guide', (pages) => pages.getFilteredByGlob('pages/guide/*.md').sort((one, other) => one.data.order - other.data.order));
  eleventy.addFilter('markdown', (text) => library.render(text));
  eleventy.addFilter('kilobytes', (bytes) => String(Math.round(bytes / 1024)));
  // A figure of the explainer: its script fills the stage when it comes into view.
  eleventy.addPairedShortcode('figure', (caption, name, label) =>
    [
      `<figure class="live" id="${name}" data-figure="${name}" aria-label="${label}">`,
      '<div class="stage"><p class="waiting">This figure is computed in your browser as it comes into view.</p></div>',
      '<p class="reading" role="status"></p>',
      `<figcaption>\n\n${caption.trim()}\n\n</figcaption>`,
      '</figure>',
    ].join('\n'),
  );
  return {
    dir: { input: 'pages', includes: '../layouts', data: '../data', output: '../out/site' },
    markdownTemplateEngine: 'njk',
    htmlTemplateEngine: 'njk',
  };
}

const slugify = (heading) =>
  heading
    .toLowerCase()
    .replaceAll(/[^\p{L}\p{N}]+/gu, '-')
    .replaceAll(/^-|-$/g, '');

/** The same links, from the folder of the page at `url`. */
function withRelativeLinks(html, url) {
  const folder = url.endsWith('/') ? url : `${dirname(url)}/`;
  return html.replaceAll(/(\s(?:href|src|data-root|data-frames)=")\/(?!\/)([^"]*)"/g, (_, begin, path) => {
    const to = posix.relative(folder, `/${path}`) || '.';
    return `${begin}${to}${path.endsWith('/') || path === '' ? '/' : ''}"`;
  });
}
