// The parts of a page that are generated stand between markers: <!-- begin NAME … --> and <!-- end NAME -->.

import { Stop } from './run.mjs';

/** The text of the page at `path` with other text in the marked parts that `parts` names. */
export function marked(page, path, parts) {
  let text = page;
  for (const [name, part] of Object.entries(parts)) {
    const place = new RegExp(`(<!-- begin ${name}\\b[^>]*-->\n)(?:[^]*?\n)??(<!-- end ${name} -->)`);
    if (!place.test(text)) throw new Stop(`${path} has no part '${name}' between markers.`);
    text = text.replace(place, (_, begin, end) => `${begin}\n${part.trim()}\n\n${end}`);
  }
  return text;
}
