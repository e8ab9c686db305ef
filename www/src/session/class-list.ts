//! The list of classes: read from files, and kept in this browser for the next clip.

import { PageError } from '../common/errors.js';
import type { Store } from '../state/state.js';

const texts = {
  added: (count: number): string =>
    count === 0 ? 'All of these classes are in the list already.' : `${count === 1 ? 'One class' : `${count} classes`} added to the list.`,
  none: (name: string): string => `“${name}” is no list of classes: a text with one a line, labels of CVAT, or categories of COCO.`,
};

/** Where the browser keeps the list. */
const KEY = 'veronese-classes';
/** Text that is no name: coordinates or run lengths. */
const NUMBERS = /^\d+[\s,]+[\d.]/;
const LONGEST = 100;

/** The names in a text, one a line, each once. */
export function namesIn(text: string): string[] {
  return [...new Set(text.split('\n').map((line) => line.trim()).filter((line) => line !== ''))];
}

/**
 * Adds the classes of files to the list: text with one a line, labels of CVAT, categories of COCO. Returns what to say
 * about it; `null` unless all are such lists, and nothing is added. `chosen`: as lists of classes, so that masks beside them do not matter,
 * and what is none is an error.
 */
export async function importClasses(files: readonly File[], store: Store, chosen = false): Promise<string | null> {
  const lists = await Promise.all(files.map(async (file) => classesIn(file.name, await file.text(), chosen)));
  const at = lists.indexOf(null);
  if (at >= 0 && chosen) throw new PageError('no-classes', texts.none(files[at]!.name));
  if (at >= 0 || lists.length === 0) return null;
  const { classList } = store.get();
  const all = [...new Set([...classList, ...lists.flatMap((names) => names ?? [])])];
  store.set({ classList: all });
  return texts.added(all.length - classList.length);
}

/** `null` for a file that is no list of classes. */
function classesIn(name: string, text: string, chosen: boolean): string[] | null {
  if (/\.json$/i.test(name)) return classesInJson(text, chosen);
  const names = namesIn(text.replace(/^\ufeff/, ''));
  const isList = names.length > 0 && !/^gt\.txt$/i.test(name) && names.every((line) => line.length <= LONGEST && !NUMBERS.test(line));
  return isList ? names : null;
}

function classesInJson(text: string, chosen: boolean): string[] | null {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch {
    return null;
  }
  if (Array.isArray(json)) return namesOf(json);
  if (!(json instanceof Object && 'categories' in json && Array.isArray(json.categories))) return null;
  const masks = 'annotations' in json && Array.isArray(json.annotations) && json.annotations.length > 0;
  if (masks && !chosen) return null;
  const idOf = (entry: unknown): number => (entry instanceof Object && 'id' in entry ? Number(entry.id) : 0);
  return namesOf(json.categories.toSorted((one: unknown, other: unknown) => idOf(one) - idOf(other)));
}

/** The names of entries that all have one. */
function namesOf(entries: readonly unknown[]): string[] | null {
  const names = entries.map((entry) => (entry instanceof Object && 'name' in entry && typeof entry.name === 'string' ? entry.name.trim() : ''));
  return names.length > 0 && !names.includes('') ? [...new Set(names)] : null;
}

/** Takes over the list of the last time, after what is listed already, and keeps it from now on. */
export function keepClasses(store: Store): void {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(KEY) ?? '[]');
    const names = Array.isArray(kept) ? kept.filter((name) => typeof name === 'string') : [];
    const { classList } = store.get();
    if (names.length > 0) store.set({ classList: [...new Set([...classList, ...names])] });
  } catch {
    // A browser that keeps nothing begins without a list.
  }
  const keep = (): void => {
    try {
      localStorage.setItem(KEY, JSON.stringify(store.get().classList));
    } catch {
      // The list is in the project still.
    }
  };
  store.subscribe(({ classList }, before) => {
    if (classList !== before.classList) keep();
  });
}
