//! Copying the picture of the frame on screen with its masks, and a link to the page with its settings.

import { type VNode, render } from 'preact';
import { strings } from '../common/strings.js';
import { linkFor } from '../export/link.js';
import { overlayPicture } from '../export/overlay.js';
import type { Session } from '../session/session.js';
import type { Store } from '../state/state.js';
import { copyText } from './clipboard.js';
import { usePart } from './component.js';

export function mountCopies(root: HTMLElement, store: Store, session: Session): void {
  render(<Copies store={store} session={session} />, root);
}

function Copies({ store, session }: { store: Store; session: Session }): VNode {
  const isEmpty = usePart(store, ({ result, live }) => result === null || live !== null);
  const copyPicture = (): void => {
    const { result, look } = store.get();
    if (result === null) return;
    // Some browsers must be promised the picture while the press is handled.
    const picture = overlayPicture(result, look);
    Promise.resolve()
      .then(() => navigator.clipboard.write([new ClipboardItem({ 'image/png': picture })]))
      .then(
        () => session.say(strings.copiedText('picture')),
        () => session.say(strings.errors.noClipboard, 'no-clipboard'),
      );
  };
  return (
    <>
      <button type="button" class="button small quiet" disabled={isEmpty} onClick={copyPicture}>
        Copy picture
      </button>
      <button type="button" class="button small quiet" onClick={() => copyText(linkFor(store.get(), location.href), strings.copiedText('link with the settings'), session)}>
        Copy link
      </button>
    </>
  );
}
