// The Web Worker: a file of its own, so that a strict content security policy lets it run.

import type { Request } from '../calls/messages.js';
import { serve } from './serve.js';

const answer = serve((reply, transfer) => {
  self.postMessage(reply, { transfer });
});
self.addEventListener('message', (event: MessageEvent<Request>) => void answer(event.data));
