//! Saves the work on what is open as a file. Loaded with what has a button for it.

import { codeOf, sentenceOf } from '../common/errors.js';
import { strings } from '../common/strings.js';
import { save } from '../export/save.js';
import type { Session } from '../session/session.js';

export async function saveProject(session: Session): Promise<void> {
  try {
    const file = await session.projects.file();
    if (file === null) return session.say(strings.projects.nothingYet);
    save(file.content, file.content.type, file.name);
    session.say(strings.projects.saved(file.name));
  } catch (error) {
    session.say(sentenceOf(error), codeOf(error));
  }
}
