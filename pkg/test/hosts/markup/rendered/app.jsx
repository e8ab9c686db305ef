import { useRef, useState } from 'react';
import { VeroneseSegmenter } from 'veronese/react';
import { ended, failed, frames } from './clip.js';

/** The first clip is there from the start, the second one when the first has ended; the reference is the element. */
export function App() {
  const element = useRef(null);
  const [clip, setClip] = useState(frames.slice(0, 1).concat(frames));
  const onTracks = (event) => {
    if (event.target !== element.current) failed({ detail: { code: 'reference', message: String(element.current) } });
    if (clip !== frames) setClip(frames);
    else ended(event);
  };
  return <VeroneseSegmenter ref={element} id="masks" className="wide" frames={clip} motions={3} quality="fast" grouped onTracks={onTracks} onError={failed} />;
}
