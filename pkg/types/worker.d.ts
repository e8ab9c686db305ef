// The worker file. Start it with `new Worker`; it has no exports.

export {};
