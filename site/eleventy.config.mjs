// Makes the site's pages. scripts/site.mjs runs it, and puts the page, the package and the references beside them.
//
// Eleventy, because it makes plain HTML of Markdown and adds no script: a page weighs what it says. Formulas are set as MathML and code is
// coloured while the site is built. All links are relative, so that the site works in any folder of any server.

import { dirname, posix } from 'node:path';

import highlighting from '@11ty/eleventy-plugin-syntaxhighlight';
import katex from '@vscode/markdown-it-katex';
import anchors from 'markdown-it-anchor';

import IDENTITY from './data/identity.mjs';

export default function configure(eleventy) {
  eleventy.addPlugin(highlighting);
  let library;
  eleventy.amendLibrary('md', (markdown) => {
    library = markdown;
    markdown.set({ typographer: false });
    markdown.use(katex.default ?? katex, { output: 'mathml', throwOnError: true, strict: 'error' });
    markdown.use(anchors, { level: [2, 3], slugify, permalink: anchors.permalink.headerLink({ safariReaderFix: true }), tabIndex: false });
  });
  // The page has the same colours, buttons and name.
  const shared = '../www/src/styles';
  eleventy.addPassthroughCopy({ styles: 'styles', [`${shared}/shared.css`]: 'styles/shared.css', [`${shared}/wordmark/*.woff2`]: 'styles/wordmark', 'pages/guide/images': 'guide/images' });
  eleventy.addTransform('relative', function relative(content) {
    const { outputPath, url } = this.page;
    return outputPath?.endsWith('.html') ? withRelativeLinks(content, url) : content;
  });
  eleventy.addTransform('letters', (content) => content.replaceAll(/<(m[in]) mathvariant="(bold|script)">(\w+)<\/\1>/g, (_, tag, style, text) => `<${tag}>${styled(text, style)}</${tag}>`));
  eleventy.addTransform('formulas', (content) => together(numbersBeside(content)));
  // Parts that scroll can be reached by keys.
  eleventy.addTransform('scrolling', (content) =>
    content.replaceAll(/<pre(?![^>]*tabindex)/g, '<pre tabindex="0"').replaceAll(/<table>(.*?)<\/table>/gs, '<div class="scroll" role="group" aria-label="Table" tabindex="0"><table>$1</table></div>'),
  );
  // An article's table of contents follows its headings.
  eleventy.addTransform('contents', (content) => content.replace(/(<nav class="contents"[^>]*>)(?=<\/nav>)/, (nav) => nav + contents(content)));
  eleventy.addCollection('guide', (pages) => pages.getFilteredByGlob('pages/guide/*.md').sort((one, other) => one.data.order - other.data.order));
  eleventy.addFilter('markdown', (text) => library.render(text));
  eleventy.addFilter('decimals', (value) => value.toFixed(2));
  eleventy.addFilter('meanOf', (rows, name) => rows.reduce((sum, row) => sum + row[name], 0) / rows.length);
  eleventy.addFilter('row', (rows, name, value) => rows.find((row) => row[name] === value));
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

/** Bold and script letters as characters of their own: browsers ignore the style of a MathML element. */
function styled(text, style) {
  const [capitals, small, digits] = style === 'bold' ? [0x1d400, 0x1d41a, 0x1d7ce] : [0x1d49c, 0x1d4b6];
  // These letters of the script were in Unicode before the others.
  const old = style === 'script' ? { B: 'ℬ', E: 'ℰ', F: 'ℱ', H: 'ℋ', I: 'ℐ', L: 'ℒ', M: 'ℳ', R: 'ℛ', e: 'ℯ', g: 'ℊ', o: 'ℴ' } : {};
  const first = [
    ['A', 'Z', capitals],
    ['a', 'z', small],
    ['0', '9', digits],
  ];
  return Array.from(text, (letter) => {
    const range = first.find(([from, to, start]) => start && letter >= from && letter <= to);
    return old[letter] ?? (range ? String.fromCodePoint(range[2] + letter.codePointAt(0) - range[0].codePointAt(0)) : letter);
  }).join('');
}

/**
 * The number of a formula beside it: KaTeX puts it into the formula, in a table as wide as the line, where it is cut off with a formula that
 * is wider.
 */
function numbersBeside(html) {
  const numbered = /<p class="katex-block"><span class="katex">(<math [^>]*display="block"><semantics>)<mtable width="100%"><mtr><mtd width="50%"><\/mtd><mtd>((?:(?!<\/math>).)*)<\/mtd><mtd width="50%"><\/mtd><mtd><mtext>([^<]*)<\/mtext><\/mtd><\/mtr><\/mtable>(.*?<\/math>)<\/span><\/p>/gs;
  return html.replaceAll(numbered, (_, begin, formula, number, end) => `<p class="katex-block numbered"><span class="katex">${begin}<mrow>${formula}</mrow>${end}</span><span class="number">${number}</span></p>`);
}

/** A formula in a line of text and what is written next to it without a space: a browser may break the line around a formula. */
function together(html) {
  return html.replaceAll(/([(“]?)(<span class="katex"><math (?:(?!display=)[^>])*>(?:(?!<\/math>).)*<\/math><\/span>)([^\s<]*)/gs, (whole, before, formula, after) =>
    before || after ? `<span class="together">${whole}</span>` : whole,
  );
}

/** The sections of a page as a list of links. */
function contents(html) {
  const sections = html.matchAll(/<h2 id="([^"]+)"[^>]*><a[^>]*>(.*?)<\/a><\/h2>/gs);
  return `<ol>${Array.from(sections, ([, id, title]) => `<li><a href="#${id}">${title.trim()}</a></li>`).join('')}</ol>`;
}

/** The same links, from the folder of the page at `url`. The page of what is missing is shown at any address, so that its links are whole. */
function withRelativeLinks(html, url) {
  const whole = url === '/404.html' ? new URL(IDENTITY.site).pathname : undefined;
  const folder = url.endsWith('/') ? url : `${dirname(url)}/`;
  return html.replaceAll(/(\s(?:href|src|data-root|data-frames)=")\/(?!\/)([^"]*)"/g, (_, begin, path) => {
    if (whole) return `${begin}${whole}${path}"`;
    const to = posix.relative(folder, `/${path}`) || '.';
    return `${begin}${to}${path.endsWith('/') || path === '' ? '/' : ''}"`;
  });
}
