// Code of a user of React's component; compiled under strict settings, never run.

import { useRef, useState } from 'react';
import { VeroneseSegmenter, type VeroneseSegmenterElement } from 'veronese/react';

export function Pair({ first, second }: { first: string; second: File }) {
  const [count, setCount] = useState(0);
  const element = useRef<VeroneseSegmenterElement>(null);
  const masks = () => element.current?.labels()?.length;
  return (
    <>
      <VeroneseSegmenter ref={element} className="wide" first={first} second={second} motions={3} grouped onResult={({ detail }) => setCount(detail.count)} />
      <button onClick={masks}>{count}</button>
    </>
  );
}

export function Clip({ files }: { files: File[] }) {
  return <VeroneseSegmenter name="masks" required quality="fast" frames={files} onTracks={({ detail }) => detail.objects} onFrame={({ detail }) => detail.labels} aria-label="Masks" />;
}

export const mistakes = [
  // @ts-expect-error an unknown quality
  <VeroneseSegmenter quality="good" />,
  // @ts-expect-error a misspelt attribute
  <VeroneseSegmenter motion="2" />,
  // @ts-expect-error the number of motions is in the detail
  <VeroneseSegmenter onResult={({ count }) => console.log(count)} />,
  // @ts-expect-error no frames
  <VeroneseSegmenter frames={5} />,
  // @ts-expect-error nothing stands inside
  <VeroneseSegmenter>text</VeroneseSegmenter>,
];
