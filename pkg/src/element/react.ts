// `veronese/react`: the element as a component of React. A page that a server has rendered gets neither properties nor listeners of an
// element of its own when React takes it over, so that the component gives all that is the element's by effects: listeners first.

'use client';

import { createElement, forwardRef, useEffect, useImperativeHandle, useRef } from 'react';
import type { FrameSource } from '../../types/element-class.js';
import type { VeroneseSegmenterElement } from './element-class.js';

export { VeroneseSegmenterElement } from './element.js';

const ATTRIBUTES = ['src', 'motions', 'quality', 'subject', 'grouped', 'name', 'disabled', 'required'] as const;
const PROPERTIES = ['messages', 'frames', 'currentFrame', 'selected'] as const;
/** Listeners and the events that they hear. */
const EVENTS = {
  onProgress: 'progress',
  onResult: 'result',
  onFrame: 'frame',
  onTracks: 'tracks',
  onShow: 'show',
  onSelect: 'select',
  onError: 'error',
} as const;

const OWN: readonly string[] = ['first', 'second', ...ATTRIBUTES, ...PROPERTIES, ...Object.keys(EVENTS)];

export const VeroneseSegmenter = forwardRef<VeroneseSegmenterElement>(function VeroneseSegmenter(props, ref) {
  const place = useRef<VeroneseSegmenterElement | null>(null);
  const latest = useRef(props);
  const element = () => place.current as VeroneseSegmenterElement;
  useImperativeHandle(ref, element, []);

  useEffect(() => {
    latest.current = props;
  });
  useEffect(() => {
    const listening = new AbortController();
    for (const [name, type] of Object.entries(EVENTS)) {
      const heard = (event: Event) => (latest.current[name] as ((event: Event) => void) | undefined)?.(event);
      element().addEventListener(type, heard, { signal: listening.signal });
    }
    return () => listening.abort();
  }, []);
  for (const name of PROPERTIES) {
    useEffect(() => {
      if (props[name] !== undefined) Object.assign(element(), { [name]: props[name] });
    }, [props[name]]);
  }
  for (const name of ATTRIBUTES) {
    useEffect(() => attribute(element(), name, props[name]), [props[name]]);
  }
  const { first, second } = props;
  useEffect(() => {
    const areNames = [first, second].every((source) => source === undefined || typeof source === 'string');
    for (const [name, source] of Object.entries({ first, second })) attribute(element(), name, areNames ? source : undefined);
    if (areNames || first === undefined || second === undefined) return;
    element()
      .setFrames(first as FrameSource, second as FrameSource)
      .catch(() => undefined); // the event has the error
  }, [first, second]);

  const others = Object.fromEntries(Object.entries(props).filter(([name]) => !OWN.includes(name)));
  return createElement('veronese-segmenter', { ...others, ref: place });
});

function attribute(element: Element, name: string, value: unknown): void {
  if (value === undefined || value === false) element.removeAttribute(name);
  else element.setAttribute(name, value === true ? '' : `${value as string | number}`);
}
