//! The row of controls under the picture: which frame, which colours, how strong.

import type { Store } from '../state.js';
import { strings } from '../strings.js';
import { find } from './markup.js';

export function mountLook(form: HTMLFormElement, store: Store): void {
  const radio = (name: string, value: string): HTMLInputElement => find(form, `[name=${name}][value=${value}]`, HTMLInputElement);
  const frames = { first: radio('frame', 'first'), second: radio('frame', 'second') };
  const colourings = { motions: radio('colouring', 'motions'), groups: radio('colouring', 'groups') };
  const opacity = find(form, '[name=opacity]', HTMLInputElement);
  const opacityValue = find(form, '#opacity-value', HTMLOutputElement);
  const outlines = find(form, '[name=outlines]', HTMLInputElement);

  form.addEventListener('submit', (event) => event.preventDefault());
  form.addEventListener('input', (event) => {
    if (event.target === opacity) store.look({ opacity: opacity.valueAsNumber / 100 });
    else if (event.target === outlines) store.look({ outlines: outlines.checked });
    else {
      store.look({
        frame: frames.second.checked ? 'second' : 'first',
        colouring: colourings.groups.checked ? 'groups' : 'motions',
      });
    }
  });
  store.subscribe(({ look, pair }) => {
    frames[look.frame].checked = true;
    frames.first.disabled = pair.first === null;
    frames.second.disabled = pair.second === null;
    colourings[look.colouring].checked = true;
    opacityValue.textContent = strings.percent(look.opacity);
  });
}
