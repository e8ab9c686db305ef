//! Suggestions below the list of masks: which of them may belong together, or may be two things, with buttons to do so or not.

import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { type Suggestion, suggestionsOf } from '../result/junctions.js';
import type { Session } from '../session/session.js';
import { type State, type Store, isAwaited } from '../state/state.js';
import { element, find } from './markup.js';

export function mountSuggestions(root: ParentNode, store: Store, session: Session): void {
  const list = find(root, '#suggestions', HTMLUListElement);
  const title = find(root, '#motions-title', HTMLElement);
  let shown = '';

  store.subscribe((now) => {
    // As the list of masks, they stay until those of the next result are known. A preview has none.
    const { run } = now;
    list.inert = isAwaited(now) || (run.phase === 'working' && run.work === 'segmenting');
    if (list.inert && now.look.kind === 'groups' && now.live === null) return;
    const suggestions = suggestionsFor(now);
    const asked = suggestions.map((suggestion) => ({ suggestion, sentence: sentenceFor(suggestion, now) }));
    // Suggestions that stay are left alone: they were read out, and may have the focus.
    const text = JSON.stringify(asked);
    if (text === shown) return;
    shown = text;
    const focused = list.contains(document.activeElement);
    list.replaceChildren(...asked.map(({ suggestion, sentence }) => rowFor(suggestion, sentence, store, session)));
    if (focused) (list.querySelector('button') ?? title).focus({ preventScroll: true });
  });
}

function suggestionsFor({ found, result, look, live }: State): Suggestion[] {
  if (found === null || result === null || live !== null || look.kind !== 'groups') return [];
  return suggestionsOf(found, result.segmentation, look.dismissed);
}

function sentenceFor({ advice, groups: [one, other] }: Suggestion, { look }: State): string {
  const { mayBelong, mayBeGround, mayBeTwo } = strings.suggestions;
  if (advice === 'separate') return mayBeTwo(nameOf(look, one));
  return one === 0 ? mayBeGround(nameOf(look, other)) : mayBelong(nameOf(look, other), nameOf(look, one));
}

function rowFor({ advice, groups, label, junctions }: Suggestion, sentence: string, store: Store, session: Session): HTMLElement {
  const row = element('li', '', 'suggestion');
  const button = (text: string, act: () => void): HTMLButtonElement => {
    const made = element('button', text, 'button small quiet');
    made.type = 'button';
    made.setAttribute('aria-label', strings.suggestions.about(text, sentence));
    made.addEventListener('click', act);
    return made;
  };
  const { join, separate, dismiss } = strings.suggestions;
  const follow = advice === 'join' ? button(join, () => session.masks.merge(...groups)) : button(separate, () => session.masks.separate(label));
  const refuse = button(dismiss, () => store.look({ dismissed: new Set([...store.get().look.dismissed, ...junctions]) }));
  row.append(element('span', sentence), follow, refuse);
  return row;
}
