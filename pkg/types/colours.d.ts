/**
 * The colour of an object, numbers from 1 to 254, in pictures to look at: overlays, films, the element and the page. Each is one of its own. Numbers
 * that follow each other are far apart and bright, also to the colour-blind.
 */
export function objectColour(object: number): [red: number, green: number, blue: number];
