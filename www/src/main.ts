//! Wires the page together: one store, one session, and the views on their markup.

import { Session } from './session.js';
import { Store } from './state.js';
import { mountDownloads } from './views/downloads.js';
import { mountDrop } from './views/drop.js';
import { mountLook } from './views/look.js';
import { find } from './views/markup.js';
import { mountMotions } from './views/motions.js';
import { mountOptions } from './views/options.js';
import { mountOverlay } from './views/overlay.js';
import { mountPicker } from './views/picker.js';
import { mountProgress } from './views/progress.js';
import { mountStage } from './views/stage.js';
import { mountTimings } from './views/timings.js';
import { mountToast } from './views/toast.js';

const store = new Store();
const session = new Session(store);
const stage = find(document, '#stage', HTMLElement);

mountStage(stage, store);
mountOverlay(stage, store);
mountLook(find(document, '#look', HTMLFormElement), store);
mountPicker(document, store, session);
mountDrop(document.body, session);
mountMotions(document, store, session);
mountOptions(find(document, '#settings', HTMLFormElement), store, session);
mountProgress(find(document, '#run', HTMLElement), store, session);
mountToast(find(document, '#notice', HTMLElement), store);
mountTimings(find(document, '#timings', HTMLElement), store);
mountDownloads(document, store);

void session.openSample();
