//! The title of the tab says how far a long run is, and in the background also that it is done.

import { strings } from '../common/strings.js';
import type { Store } from '../state/state.js';
import { shareOf } from './clip-run.js';

export function mountTitle(page: Document, store: Store): void {
  const own = page.title;
  const isHidden = (): boolean => page.visibilityState === 'hidden';
  const show = (news: string): void => {
    const title = news === '' ? own : `${news} · ${own}`;
    if (page.title !== title) page.title = title;
  };
  store.subscribe(({ tracked }, before) => {
    if (tracked === before.tracked) return;
    const was = before.tracked?.run.phase === 'working';
    if (tracked?.run.phase === 'working') show(strings.tab.working(shareOf(tracked), tracked.clip.name));
    else if (was) show(isHidden() && tracked !== null ? strings.tab[tracked.run.phase === 'done' ? 'done' : 'stopped'](tracked.clip.name) : '');
  });
  page.addEventListener('visibilitychange', () => {
    if (!isHidden() && store.get().tracked?.run.phase !== 'working') show('');
  });
}
