// The worker thread under Node.

import { parentPort } from 'node:worker_threads';
import type { Request } from '../calls/messages.js';
import { serve } from './serve.js';

const answer = serve((reply, transfer) => parentPort?.postMessage(reply, transfer));
parentPort?.on('message', (request: Request) => void answer(request));
