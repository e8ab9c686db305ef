import { createSignal } from 'solid-js';
import { render } from 'solid-js/web';
import 'veronese/solid';
import { ended, failed, frames } from './clip.js';

function App() {
  const [motions] = createSignal(3);
  const [clip] = createSignal(frames);
  return <veronese-segmenter prop:frames={clip()} attr:motions={motions()} quality="fast" bool:grouped={motions() > 2} on:tracks={ended} on:error={failed} />;
}

render(App, document.body);
