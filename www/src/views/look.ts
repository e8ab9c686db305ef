//! The display controls under the picture: frame, masks, opacity, outlines, onion skin, arrows, residual.

import { strings } from '../common/strings.js';
import type { Kind } from '../result/masks.js';
import type { Session } from '../session/session.js';
import type { Look, Store } from '../state/state.js';
import { isSeen } from '../state/tracked.js';
import { find } from './markup.js';

const VIEWS = ['first', 'split', 'second'] as const;
const SWITCHES = ['outlines', 'onion', 'arrows', 'residual'] as const;

export function mountLook(form: HTMLFormElement, store: Store, session: Session): void {
  const radio = (name: string, value: string): HTMLInputElement => find(form, `[name=${name}][value=${value}]`, HTMLInputElement);
  const views = VIEWS.map((view) => radio('frame', view));
  const kinds = { motions: radio('colouring', 'motions'), groups: radio('colouring', 'groups'), objects: radio('colouring', 'objects') };
  const clipOnly = find(form, '#kind-objects', HTMLElement);
  const onionOnly = find(form, '#onion-skin', HTMLElement);
  const kindsBox = find(form, '#kinds', HTMLFieldSetElement);
  const opacity = find(form, '[name=opacity]', HTMLInputElement);
  const opacityValue = find(form, '#opacity-value', HTMLOutputElement);
  const switches = SWITCHES.map((name) => find(form, `[name=${name}]`, HTMLInputElement));

  form.addEventListener('submit', (event) => event.preventDefault());
  opacity.addEventListener('input', () => store.look({ opacity: opacity.valueAsNumber / 100 }));
  for (const view of views) {
    view.addEventListener('change', () => store.look({ view: view.value as Look['view'], blinking: false }));
  }
  for (const kind of Object.values(kinds)) kind.addEventListener('change', () => session.shown.choose(kind.value as Kind));
  for (const input of switches) input.addEventListener('change', () => store.look({ [input.name]: input.checked }));

  store.subscribe(({ look, pair, tracked, live }, before) => {
    if (live !== before.live) kindsBox.hidden = live !== null;
    if (tracked !== before.tracked) clipOnly.hidden = !isSeen(tracked);
    if (look === before.look && pair === before.pair) return;
    onionOnly.hidden = look.kind !== 'objects';
    const both = pair.first !== null && pair.second !== null;
    for (const view of views) {
      view.checked = view.value === look.view;
      view.disabled = view.value === 'split' ? !both : pair[view.value as 'first' | 'second'] === null;
    }
    kinds[look.kind].checked = true;
    switches.forEach((input) => (input.checked = look[input.name as (typeof SWITCHES)[number]]));
    opacity.value = String(Math.round(look.opacity * 100));
    opacityValue.textContent = strings.percent(look.opacity);
  });
}
