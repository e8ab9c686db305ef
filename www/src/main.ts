//! Wires the page together: one store, one session, and the views mounted on their markup.

import { imported } from './common/loaded.js';
import { settingsFromHash } from './export/link.js';
import { SAMPLES } from './frames/samples.js';
import { keepForOffline } from './offline/register.js';
import { sessionOf } from './session/session.js';
import { Store } from './state/state.js';
import { mountBlink } from './views/blink.js';
import { mountClasses } from './views/classes.js';
import { mountClipRun } from './views/clip-run.js';
import { mountCompare } from './views/compare.js';
import { mountDrop } from './views/drop.js';
import { mountFolders } from './views/folders.js';
import { mountGestures } from './views/gestures.js';
import { mountKeys } from './views/keys.js';
import { mountLanes } from './views/lanes.js';
import { LateBrush } from './views/late-brush.js';
import { mountLeaving } from './views/leaving.js';
import { mountLook } from './views/look.js';
import { find } from './views/markup.js';
import { mountObjects } from './views/objects.js';
import { mountOnion } from './views/onion.js';
import { mountOnOpening } from './views/opening.js';
import { mountOptions } from './views/options.js';
import { mountOverlay } from './views/overlay.js';
import { mountPicker } from './views/picker.js';
import { mountRange } from './views/range.js';
import { mountReview } from './views/review.js';
import { mountSamples } from './views/samples.js';
import { mountSeveral } from './views/several.js';
import { keysFor } from './views/shortcuts.js';
import { mountShowing } from './views/showing.js';
import { mountStage } from './views/stage.js';
import { mountStatus } from './views/status.js';
import { mountTimeline } from './views/timeline.js';
import { mountTitle } from './views/title.js';
import { mountToast } from './views/toast.js';
import { mountToolHelp } from './views/tool-help.js';
import { mountTools } from './views/tools.js';
import { mountZoom } from './views/zoom.js';

const store = new Store();
const session = sessionOf(store);
const stage = find(document, '#stage', HTMLElement);

mountStage(stage, store);
mountOverlay(stage, store);
mountOnion(find(stage, '#onion', SVGSVGElement), store);
mountCompare(stage, store);
const zoom = mountZoom(stage, store);
mountGestures(find(stage, '.layers', HTMLElement), store, session, zoom, new LateBrush(stage, store, session));
mountLook(find(document, '#look', HTMLFormElement), store, session);
mountBlink(store);
mountTools(find(document, '#tools', HTMLFormElement), store, session);
mountToolHelp(find(stage, '#tool-help', HTMLElement), store);
mountSamples(find(document, '#samples', HTMLElement), store, session);
mountTimeline(find(document, '#timeline', HTMLElement), store, session);
mountRange(find(document, '#timeline', HTMLElement), store, session);
mountClipRun(find(document, '#clip-run', HTMLElement), store, session);
mountReview(find(document, '#timeline', HTMLElement), store);
mountLanes(find(document, '#timeline', HTMLElement), store, session);
mountDrop(document.body, session);
mountFolders(find(document, '#folders', HTMLDialogElement), store);
mountObjects(document, store, session);
mountClasses(document, store);
mountSeveral(document, store, session);
mountOptions(find(document, '#settings', HTMLFormElement), store);
mountStatus(find(document, '#run', HTMLElement), store, session);
mountToast(find(document, '#notice', HTMLElement), store);
mountLeaving(window, store, session);
mountTitle(document, store);
mountOnOpening(find(document, '#export', HTMLElement), session, async (panel) => (await imported(() => import('./views/panel.js'))).mountPanel(panel, store, session));
mountKeys(find(document, '#keys', HTMLDialogElement), find(document, '#open-keys', HTMLElement), store, session, keysFor(store, session, zoom));

// Once there is work.
let waiting = true;
const mountWhenKept = (): void => {
  if (!waiting) return;
  waiting = false;
  void import('./views/kept.js').then(({ mountKept }) => mountKept(document, store, session), () => undefined);
};
store.subscribe(({ keeping }) => {
  if (keeping.is !== 'nothing') mountWhenKept();
});
void session.projects.mayBeKept().then((may) => may && mountWhenKept());

keepForOffline(store);

const linked = settingsFromHash(location.hash);
store.set({ settings: { ...store.get().settings, ...linked.settings } });
if (linked.automatic !== null) store.set({ automatic: linked.automatic });
window.addEventListener('hashchange', () => {
  const { settings, sample } = settingsFromHash(location.hash);
  const set = (): void => store.set({ settings: { ...store.get().settings, ...settings } });
  set();
  // Again: what the link says goes before what was left with the sample.
  if (sample !== null) void session.open.sample(sample).then(set);
});

const opened = linked.sample ?? SAMPLES[0];
if (location.hash === '') mountShowing(window, store, session, opened);
void (linked.sample === null ? session.open.begin(opened) : session.open.sample(opened));
// Later than the sample: what a person has chosen already is newer.
mountPicker(document, store, session);
