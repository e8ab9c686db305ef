// Opens clips: checks what they are made of, and reads their journals. What clips do is loaded with the first one.

import type { Clip, ClipJournal } from '../../../types/index.js';
import { checkedBytes, entriesOf, invalidOption, isObject, reading } from '../../common/checks.js';
import { VeroneseError } from '../../common/errors.js';
import type { Places } from '../places.js';
import { taken } from '../taking.js';
import { parted } from '../tasks.js';
import type { House, OpenedClip } from './clip.js';
import { ClipFrames } from './frames.js';

/** What the place where the package runs gives to clips. */
export interface ClipHost {
  /** Reads frames that are not pixels. */
  places: Places;
  /** Opens the journal of a name. */
  journal: (name: string) => Promise<ClipJournal>;
}

/** `house` finds a home for the clip, now and when that is lost. */
export async function openedClip(given: unknown, options: unknown, house: House, { places, journal: named }: ClipHost): Promise<Clip> {
  const { frames, journal, saved, markUnknown } = reading(() => checked(given, options, places));
  const [{ OpenedClip }, { JournalWriter, MemoryJournal }] = await Promise.all([import('./clip.js'), import('./journal.js')]);
  const opened: ClipJournal = typeof journal === 'string' ? await named(journal) : (journal ?? new MemoryJournal());
  const writer = new JournalWriter(opened);
  let clip: OpenedClip | undefined;
  try {
    const content = await writer.content();
    if (content && saved) throw new VeroneseError('invalid-option', "option 'saved': the journal has a clip already: give one of the two");
    const from = content ?? saved;
    clip = new OpenedClip({ frames, journal: opened, writer, markUnknown, house });
    const answer = await clip.open(from);
    const { used = 0, isDamaged = false } = answer;
    if (saved && used < saved.length) throw new VeroneseError('invalid-option', "option 'saved': it is damaged or cut off");
    if (content && used < content.length) await writer.cut(content, used, isDamaged);
    if (saved) await writer.write(saved, true);
    clip.isDamaged = isDamaged;
    clip.begin(answer);
    return clip;
  } catch (thrown) {
    if (clip) await clip.close();
    else await opened.close?.();
    throw thrown;
  }
}

function checked(given: unknown, options: unknown, places: Places) {
  const { journal, saved, ...rest } = entriesOf(options, ['journal', 'saved', 'markUnknown', 'maxSize']);
  const { maxSize, settings } = parted(rest, ['markUnknown', 'maxSize']);
  const { markUnknown = false } = settings;
  if (typeof markUnknown !== 'boolean') throw invalidOption('markUnknown', 'true or false', markUnknown);
  if (journal !== undefined && !(typeof journal === 'string' ? journal !== '' : isJournal(journal))) {
    throw invalidOption('journal', 'a name, or an object with read, append and replace', journal);
  }
  const bytes = saved === undefined ? undefined : (taken([checkedBytes('what was saved', saved)], false)[0] as Uint8Array);
  return {
    frames: new ClipFrames(given, places, maxSize),
    journal: journal as string | ClipJournal | undefined,
    saved: bytes,
    markUnknown,
  };
}

function isJournal(value: unknown): value is ClipJournal {
  return isObject(value) && ['read', 'append', 'replace'].every((name) => typeof value[name] === 'function');
}
