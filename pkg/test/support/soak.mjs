// npm test runs those cases of a sweep that find faults; npm run soak all of them.

export const soaking = process.env.VERONESE_SOAK !== undefined;

/** `few`, and `more` as well with npm run soak. */
export function cases(few, more) {
  return soaking ? [...few, ...more] : few;
}
