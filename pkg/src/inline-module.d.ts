// Written by scripts/glue.mjs.

/** Base64 of the deflated core module. */
export const packed: string;
