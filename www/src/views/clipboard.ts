//! Copies text to the clipboard and reports it.

import { strings } from '../common/strings.js';
import type { Session } from '../session/session.js';

export function copyText(text: string, done: string, session: Session): void {
  navigator.clipboard.writeText(text).then(
    () => session.say(done),
    () => session.say(strings.errors.noClipboard, 'no-clipboard'),
  );
}
