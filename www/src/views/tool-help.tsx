//! What the tool does, over the picture; or why nothing can be drawn.

import { type VNode, render } from 'preact';
import { nameOf } from '../common/naming.js';
import { strings } from '../common/strings.js';
import { type State, type Store, seenIn } from '../state/state.js';
import { isDrafting, isReady, lockedIn, takesCorrections } from '../state/tracked.js';
import { usePart } from './component.js';
import { promptIn } from './pointing.js';

export function mountToolHelp(root: HTMLElement, store: Store): void {
  render(<ToolHelp store={store} />, root);
}

function ToolHelp({ store }: { store: Store }): VNode | null {
  const name = usePart(store, ({ tool }) => tool.name);
  const help = usePart(store, helpOf);
  return help === '' ? null : <span data-help={name}>{help}</span>;
}

function helpOf(state: State): string {
  const { tool, look } = state;
  if (tool.name === 'look') return '';
  if (tool.name === 'box' && promptIn(state) !== null) return strings.pointingHelp[tool.pointing];
  return strings.toolHelp(tool.name, tool.exact, look.selected === 0, whyNot(state));
}

/** Why nothing can be drawn on the frame that is seen; `null` if something can. */
function whyNot(state: State): string | null {
  const { tracked, look, tool } = state;
  if (isDrafting(tracked)) return strings.notices.drafts;
  if (!isReady(tracked)) return strings.notices.notReady;
  const seen = seenIn(state);
  if (seen !== null && !takesCorrections(tracked, seen.index)) return strings.notTracked;
  if (tool.name === 'box') return null;
  if (look.selected === null) return strings.notices.chooseMask;
  return lockedIn(tracked).has(look.selected) ? strings.notices.isLocked(nameOf(look, look.selected)) : null;
}
