//! Taking the frame on screen away, with its masks: as files, to the clipboard, as something that makes them again.

import { strings } from '../common/strings.js';
import { ANNOTATIONS } from '../export/annotations.js';
import { type Format, exportOf } from '../export/format.js';
import { FORMATS, LABELS, MASKS, OVERLAY, RESULT } from '../export/formats.js';
import { linkFor } from '../export/link.js';
import { commandFor, scriptFor } from '../export/reproduce.js';
import { save } from '../export/save.js';
import type { Session } from '../session/session.js';
import type { Settings } from '../state/settings.js';
import type { Result, State, Store } from '../state/state.js';
import { isDrafting } from '../state/tracked.js';
import { copyText } from './clipboard.js';
import { element, find } from './markup.js';

/** The formats that have a button of their own. */
const BUTTONS: readonly Format[] = [LABELS, MASKS, RESULT];

/** Texts to copy; those with a result need one. */
const COPIES: readonly { readonly title: string; readonly text: (state: State, result: Result) => string }[] = [
  { title: 'command', text: (state, result) => commandFor(result, settingsOf(state), state.look) },
  { title: 'JavaScript', text: (state, result) => scriptFor(result, settingsOf(state), state.look) },
];

function settingsOf({ settings, forced }: State): Settings {
  return { ...settings, motions: forced ?? settings.motions };
}

export function mountExport(root: HTMLElement, store: Store, session: Session): void {
  const need: (HTMLButtonElement | HTMLSelectElement)[] = [];
  /** Of the motions of a pair, not of objects. */
  const ofMotions: HTMLElement[] = [];
  const button = (text: string, run: (result: Result) => void, className = 'button small quiet'): HTMLButtonElement => {
    const made = element('button', text, className);
    made.type = 'button';
    made.addEventListener('click', () => {
      const { result } = store.get();
      if (result !== null) run(result);
    });
    need.push(made);
    return made;
  };

  const download = async (format: Format): Promise<void> => {
    try {
      const { result, look, tracked } = store.get();
      if (result === null) return;
      if (look.kind === 'objects' && isDrafting(tracked)) return session.say(strings.notices.drafts);
      save(await format.make(exportOf(result, look, background.checked)), format.type, format.file);
    } catch {
      session.say(strings.errors.notWritten(format.title), 'not-written');
    }
  };
  const buttons = BUTTONS.map((format) => button(format.title, () => void download(format), 'button small'));
  find(root, '.export-buttons', HTMLElement).append(...buttons);
  ofMotions.push(...buttons.filter((_, k) => BUTTONS[k] === RESULT));

  const select = find(root, 'select', HTMLSelectElement);
  const hint = find(root, '#format-hint', HTMLElement);
  const background = find(root, '#with-background', HTMLInputElement);
  const options = FORMATS.map(({ id, title }) => new Option(title, id));
  select.append(...options);
  ofMotions.push(...options.filter((_, k) => FORMATS[k] === RESULT));
  need.push(select);
  const chosen = (): Format => FORMATS[select.selectedIndex] ?? LABELS;
  const tell = (): void => {
    hint.textContent = chosen().hint;
    background.parentElement!.hidden = !ANNOTATIONS.includes(chosen());
  };
  select.addEventListener('change', tell);
  tell();
  find(root, '.format-row', HTMLElement).append(button('Save', () => void download(chosen()), 'button small primary'));

  const copies = find(root, '.copies', HTMLElement);
  copies.append(button('Copy picture', (result) => copyPicture(OVERLAY.make(exportOf(result, store.get().look)) as Promise<Blob>, session)));
  const texts = COPIES.map(({ title, text }) => button(`Copy ${title}`, (result) => copyText(text(store.get(), result), strings.copiedText(title), session)));
  copies.append(...texts);
  ofMotions.push(...texts);
  const link = element('button', 'Copy link', 'button small quiet');
  link.type = 'button';
  link.addEventListener('click', () => copyText(linkFor(store.get(), location.href), strings.copiedText('link with the settings'), session));
  copies.append(link);

  const render = ({ result, live, look }: State): void => {
    for (const one of ofMotions) one.hidden = look.kind === 'objects';
    for (const control of need) control.disabled = result === null || live !== null;
  };
  store.subscribe(render);
  render(store.get());
}

function copyPicture(picture: Promise<Blob>, session: Session): void {
  // Some browsers must be promised the picture while the press is handled.
  Promise.resolve()
    .then(() => navigator.clipboard.write([new ClipboardItem({ 'image/png': picture })]))
    .then(
      () => session.say(strings.copiedText('picture')),
      () => session.say(strings.errors.noClipboard, 'no-clipboard'),
    );
}
