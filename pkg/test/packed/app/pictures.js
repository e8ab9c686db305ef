// Pictures of the browser in place of pixels: the same labels, also where they are closed when the call has been made; what cannot be read.

import { Segmenter, segmentClip, segmentPair } from './node_modules/veronese/dist/web.js';
import { first, second } from './frames.js';

const images = [first, second].map(({ data, width, height }) => new ImageData(new Uint8ClampedArray(data), width, height));
const onCanvas = (canvas, image) => {
  [canvas.width, canvas.height] = [image.width, image.height];
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
};
const canvasOf = (image) => onCanvas(document.createElement('canvas'), image);
const blobOf = (image) => onCanvas(new OffscreenCanvas(1, 1), image).convertToBlob();
const imageOf = async (image) => {
  const element = Object.assign(new Image(), { src: URL.createObjectURL(await blobOf(image)) });
  await element.decode();
  return element;
};
const videoFrameOf = ({ data, width, height }) => new VideoFrame(data, { format: 'RGBA', codedWidth: width, codedHeight: height, timestamp: 0 });
const KINDS = { ImageBitmap: (image) => createImageBitmap(image), VideoFrame: videoFrameOf, Blob: blobOf, Canvas: canvasOf, Image: imageOf };

const all = (make) => Promise.all(images.map(make));
const close = (pictures) => pictures.forEach((picture) => picture.close?.());
const settings = { quality: 'fast' };

async function labelsOf(clip) {
  const labels = [];
  for await (const frame of clip) labels.push(String(frame.labels));
  return labels.join();
}

/** A stream whose frames are closed when the next one is asked for. */
async function* closing(make) {
  for (const image of images) {
    const picture = await make(image);
    yield picture;
    picture.close?.();
  }
}

async function main() {
  const segmenter = new Segmenter();
  const pixels = String((await segmentPair(...images, settings)).labels);
  const clip = await labelsOf(segmentClip(images, settings));
  const small = String((await segmentPair(...images, { ...settings, maxSize: 32 })).labels);
  const differ = [];
  const compare = (name, found, expected) => found === expected || differ.push(name);
  for (const [kind, make] of Object.entries(KINDS)) {
    for (const [where, call] of [['here', segmentPair], ['in a worker', (...given) => segmenter.segmentPair(...given)]]) {
      const pictures = await all(make);
      const answer = call(...pictures, settings);
      close(pictures);
      compare(`${kind} ${where}`, String((await answer).labels), pixels);
    }
    compare(`${kind} scaled down`, String((await segmentPair(...(await all(make)), { ...settings, maxSize: 32 })).labels), small);
    compare(`${kind} beside pixels`, String((await segmentPair(images[0], await make(images[1]), settings)).labels), pixels);
    compare(`${kind} of a clip`, await labelsOf(segmenter.segmentClip(closing(make), settings)), clip);
  }
  segmenter.close();

  const closed = async (kind) => {
    const picture = await KINDS[kind](images[1]);
    picture.close();
    return picture;
  };
  const pretended = { [Symbol.toStringTag]: 'ImageBitmap' };
  const errors = [];
  for (const wrong of [await closed('ImageBitmap'), await closed('VideoFrame'), document.createElement('canvas'), new Blob(['text']), new Image(), pretended, 5]) {
    if (wrong instanceof HTMLCanvasElement) wrong.width = 0;
    errors.push(await segmentPair(images[0], wrong, settings).then(() => 'answered', ({ code, message }) => `${code}: ${message}`));
  }
  return { differ, errors };
}

globalThis.outcome = main().catch((error) => ({ error: `${error.code}: ${error.message}` }));
