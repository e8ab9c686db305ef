// Written by scripts/bundle.mjs.

/** The worker as one script, which forgets its address. */
export const code: string;
