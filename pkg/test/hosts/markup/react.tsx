// Code of a user of React; compiled under strict settings, never run.

import { useRef, useState } from 'react';
import type { ClipTrack } from 'veronese';
import { VeroneseSegmenterElement } from 'veronese/react';

export function Pair({ first, second }: { first: string; second: string }) {
  const [count, setCount] = useState(0);
  const element = useRef<VeroneseSegmenterElement>(null);
  const mask: Uint8Array | undefined = element.current?.mask(1);
  return (
    <>
      <veronese-segmenter ref={element} className="wide" first={first} second={second} motions={3} grouped onresult={({ detail }) => setCount(detail.count)} />
      {count} {mask?.length}
    </>
  );
}

export function Clip({ files }: { files: File[] }) {
  const [objects, setObjects] = useState<ClipTrack[]>([]);
  const onTracks = ({ detail }: CustomEvent<{ objects: ClipTrack[] }>) => setObjects(detail.objects);
  const onError = ({ detail }: CustomEvent<Error>) => console.error(detail.message);
  return <veronese-segmenter name="masks" required quality="fast" frames={files} ontracks={onTracks} onerror={onError} aria-label={`${objects.length} objects`} />;
}

export const mistakes = [
  // @ts-expect-error an unknown quality
  <veronese-segmenter quality="good" />,
  // @ts-expect-error a misspelt attribute
  <veronese-segmenter motion="2" />,
  // @ts-expect-error the number of motions is in the detail
  <veronese-segmenter onresult={({ count }) => console.log(count)} />,
  // @ts-expect-error no frames
  <veronese-segmenter frames={5} />,
];
