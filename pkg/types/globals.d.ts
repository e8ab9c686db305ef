// What the types name of the platform. Where its own types are loaded, these add nothing to them. Where they are not (`lib` without DOM,
// no types of Node), they are what lets a program compile.

declare global {
  interface AbortSignal {}
  interface Response {}
  interface URL {}
  namespace WebAssembly {
    interface Module {}
  }
}

export {};
