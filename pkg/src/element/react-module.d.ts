// What is used of React, whose own types are the user's.

declare module 'react' {
  export function createElement(type: string, props: object): unknown;
  export function forwardRef<T>(render: (props: Readonly<Record<string, unknown>>, ref: Ref<T>) => unknown): unknown;
  export function useEffect(effect: () => (() => void) | void, dependencies?: readonly unknown[]): void;
  export function useImperativeHandle<T>(ref: Ref<T>, make: () => T, dependencies: readonly unknown[]): void;
  export function useRef<T>(value: T): { current: T };
  type Ref<T> = { current: T | null } | null;
}
