// Search, on every page. The index is loaded when somebody searches.

const root = new URL(`${document.body.dataset.root.replace(/\/$/, '')}/`, document.baseURI);
const open = document.querySelector('.search-open');
const dialog = document.querySelector('dialog.search');
const input = dialog.querySelector('input');
const found = dialog.querySelector('.found');
const list = dialog.querySelector('.results');
const MOST = 8;

let index;
let asked = 0;

open.hidden = false;
open.addEventListener('click', show);
// A field for searches would only be emptied.
input.addEventListener('keydown', (event) => {
  if (event.key !== 'Escape') return;
  event.preventDefault();
  dialog.close();
});
input.addEventListener('input', () => void search(input.value.trim()));
dialog.addEventListener('click', ({ target }) => {
  if (target === dialog) dialog.close();
});
document.addEventListener('keydown', (event) => {
  const typing = event.target instanceof HTMLElement && event.target.matches('input, textarea, select, [contenteditable]');
  const asks = event.key === '/' || (event.key.toLowerCase() === 'k' && (event.ctrlKey || event.metaKey));
  if (typing || !asks || dialog.open) return;
  event.preventDefault();
  show();
});

function show() {
  dialog.showModal();
  input.select();
  // So that it is there with the first letter; where it fails, the search reports it.
  started().catch(() => (index = undefined));
}

async function started() {
  index ??= import(new URL('pagefind/pagefind.js', root)).then(async (made) => {
    await made.options({ baseUrl: root.pathname });
    await made.init();
    return made;
  });
  return index;
}

async function search(words) {
  const mine = ++asked;
  if (words === '') return put([], '');
  try {
    const { results } = await (await started()).search(words);
    const pages = await Promise.all(results.slice(0, MOST).map((result) => result.data()));
    if (mine !== asked) return;
    put(pages, results.length === 0 ? `Nothing found for “${words}”.` : results.length === 1 ? 'One page.' : `${results.length} pages.`);
  } catch {
    index = undefined;
    if (mine === asked) put([], 'The search could not be loaded.');
  }
}

function put(pages, text) {
  found.textContent = text;
  list.replaceChildren(
    ...pages.map(({ url, meta, excerpt }) => {
      const item = document.createElement('li');
      const link = Object.assign(document.createElement('a'), { href: url, textContent: meta.title });
      const about = document.createElement('p');
      about.innerHTML = excerpt; // made of our own pages: text and <mark>
      item.append(link, about);
      return item;
    }),
  );
}
