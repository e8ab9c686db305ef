//! The field of a class: typed, or chosen from the list.

import type { TargetedEvent, VNode } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';

interface Given {
  readonly value: string;
  readonly label: string;
  readonly title?: string;
  readonly disabled?: boolean;
  readonly take: (name: string) => void;
}

export function ClassField({ value, label, title, disabled = false, take }: Given): VNode {
  const field = useRef<HTMLInputElement>(null);
  const before = useRef('');
  // Not while it is being typed.
  useLayoutEffect(() => {
    if (document.activeElement !== field.current) field.current!.value = value;
  });
  const key = (event: TargetedEvent<HTMLInputElement, KeyboardEvent>): void => {
    if (event.key === 'Escape') {
      event.currentTarget.value = before.current;
      event.stopPropagation();
    }
    if (event.key === 'Enter' || event.key === 'Escape') event.currentTarget.blur();
  };
  return (
    <input
      ref={field}
      type="text"
      class="class"
      list="class-names"
      placeholder="Class"
      aria-label={label}
      title={title}
      disabled={disabled}
      maxLength={100}
      spellcheck={false}
      autocomplete="off"
      onFocus={({ currentTarget }) => (before.current = currentTarget.value)}
      onChange={({ currentTarget }) => take(currentTarget.value.trim())}
      onBlur={({ currentTarget }) => (currentTarget.value = value)}
      onKeyDown={key}
    />
  );
}
