// The colours of objects in pictures to look at. Label files have the palette of DAVIS, which is grey from 22 on.

/**
 * After Okabe and Ito, then bright ones: each as far as it can be from all before it, most of all from the last eight, also to eyes that lack one
 * kind of cone. Two digits for each channel.
 */
const FIRST = 'f0a00056b4e9d66eaf00a878f0e442d554000068beececec9669ff4be1a5d2c3ffff5a69a5ffa5e100966978d2a5c369d296a58796ffb4960078d2d2';
/** The others. One digit for each channel. */
const OTHERS =
  '00f922ff037bcef4d5d06b9f70bb807dba00d2fbf0378fcfab061cb8de04dfc4c9a1f7790f1f9fa03c9315acff0ba86eb503f6abf90740ef657fd2ac84435bfb0b' +
  'ced4868eef9f8571f2634bbb0abd3edea75a7f457ab780eb00f8eef686a793fdd9060d304d79a852cf7cbe6497a5d5e3fb07671ddb4c20e8c4580a6ce696cece06' +
  '5f617af63c0d9588d31cfb9092cd87dc847557e74a983ecfd872259d8e8b49255ef889a3dfc80812684bd9a3ceca2577b0e00b894e9638beaf8f76938a7eccbf39' +
  '64c6732e5e9dcfea1999478deba654e39af61c106dade58488cfa8a07f37fe9c7f65c7dd76309bca6926ce1a776ae06afdbb22e7abc686dd63b073adccd7f78979' +
  '2ba23ac977af120bcb4e5fcd88c07cd5a7d82a9cb974b2fdfae69936eb766c4fe0abd236f5aa6778fac29ea24eda75bc650cfbb588acf5aedb25e9966a98fa856e' +
  '6f6b932cdcd17d9095cbf93c8475a9dbc2bdd2a8469d738e887c';

export function objectColour(object: number): [red: number, green: number, blue: number] {
  const at = (object - 1) % (FIRST.length / 6 + OTHERS.length / 3);
  const digits = at < FIRST.length / 6 ? FIRST.slice(6 * at) : OTHERS.slice(3 * at - FIRST.length / 2).replace(/./g, '$&$&');
  const value = Number.parseInt(digits.slice(0, 6), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}
