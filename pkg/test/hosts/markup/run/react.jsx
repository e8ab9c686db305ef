import { createRoot } from 'react-dom/client';
import 'veronese/react';
import { ended, failed, frames } from './clip.js';

const element = <veronese-segmenter frames={frames} motions={3} quality="fast" grouped ontracks={ended} onerror={failed} />;
createRoot(document.body.appendChild(document.createElement('div'))).render(element);
