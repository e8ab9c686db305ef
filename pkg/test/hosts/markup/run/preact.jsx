import { render } from 'preact';
import 'veronese/preact';
import { ended, failed, frames } from './clip.js';

render(<veronese-segmenter frames={frames} motions={3} quality="fast" grouped ontracks={ended} onerror={failed} />, document.body);
