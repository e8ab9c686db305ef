//! The notice over the page: a message, or an error with its code. Messages disappear by themselves; errors and what can be chosen stay.

import { type VNode, render } from 'preact';
import { useEffect, useLayoutEffect } from 'preact/hooks';
import type { Store } from '../state/state.js';
import { usePart } from './component.js';

/** How long a message stays, milliseconds. */
const SEEN = 6000;

export function mountToast(root: HTMLElement, store: Store): void {
  render(<Toast root={root} store={store} />, root);
}

function Toast({ root, store }: { root: HTMLElement; store: Store }): VNode {
  const notice = usePart(store, ({ notice }) => notice);
  const close = (): void => store.set({ notice: null });

  useLayoutEffect(() => {
    // Shown again to be in front of what was opened meanwhile.
    root.hidePopover();
    if (notice !== null) root.showPopover();
    root.classList.toggle('error', notice?.code != null);
  }, [notice]);

  useEffect(() => {
    if (notice === null || notice.code !== null || notice.choices.length > 0) return;
    let going = 0;
    const stay = (): void => clearTimeout(going);
    const goSoon = (): void => {
      stay();
      going = window.setTimeout(close, SEEN);
    };
    goSoon();
    // Not while it is hovered or focused.
    const left = new AbortController();
    for (const event of ['pointerenter', 'focusin']) root.addEventListener(event, stay, left);
    for (const event of ['pointerleave', 'focusout']) root.addEventListener(event, goSoon, left);
    return () => {
      left.abort();
      stay();
    };
  }, [notice]);

  return (
    <>
      <p>
        <span id="notice-sentence">{notice && written(asSentence(notice.sentence))}</span>{' '}
        <small>
          <code id="notice-code">{notice?.code}</code>
        </small>{' '}
        <span id="notice-choices">
          {notice?.choices.map(({ label, choose }) => (
            <button
              type="button"
              class="button small"
              onClick={() => {
                close();
                choose();
              }}
            >
              {label}
            </button>
          ))}
        </span>
      </p>
      <button type="button" id="notice-close" class="button small quiet" onClick={close}>
        Dismiss
      </button>
    </>
  );
}

/** Text between backticks becomes code. */
function written(text: string): (string | VNode)[] {
  return text.split('`').map((part, k) => (k % 2 === 1 ? <code>{part}</code> : part));
}

/** The package's messages start in lower case and have no full stop, as usual on a command line. */
function asSentence(message: string): string {
  const ended = /[.!?]$/.test(message) ? message : `${message}.`;
  return ended.charAt(0).toUpperCase() + ended.slice(1);
}
