// Code of a user of Solid; compiled under strict settings, never run.

import { createSignal } from 'solid-js';
import { VeroneseSegmenterElement } from 'veronese/solid';

export function Pair(props: { first: string; second: string; motions: number; grouped: boolean }) {
  const [count, setCount] = createSignal(0);
  let element: VeroneseSegmenterElement | undefined;
  return (
    <>
      <veronese-segmenter
        ref={(found) => (element = found)}
        class="wide"
        quality="fast"
        attr:first={props.first}
        attr:second={props.second}
        attr:motions={props.motions}
        bool:grouped={props.grouped}
        on:result={({ detail }) => setCount(detail.count)}
      />
      {count()} {element?.labels()?.length}
    </>
  );
}

export function Clip(props: { files: File[] }) {
  return <veronese-segmenter name="masks" required prop:frames={props.files} on:tracks={({ detail }) => console.log(detail.objects.length)} aria-label="Masks" />;
}

export const mistakes = () => [
  // @ts-expect-error an unknown quality
  <veronese-segmenter quality="good" />,
  // @ts-expect-error a misspelt attribute
  <veronese-segmenter attr:motion="2" />,
  // @ts-expect-error the number of motions is in the detail
  <veronese-segmenter on:result={({ count }) => console.log(count)} />,
  // @ts-expect-error no frames
  <veronese-segmenter prop:frames={5} />,
];
