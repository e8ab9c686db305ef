// The file of the workers: to be started by `new Worker`, not imported for anything.

export {};
