// Written by scripts/glue.mjs.

/** Base64 of the deflated core module. */
export const frames: string;

/** Base64 of the deflated module of measurements. */
export const points: string;
