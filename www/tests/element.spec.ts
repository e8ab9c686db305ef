//! <veronese-segmenter> by itself: clips, keyboard, forms.
// cspell:ignore bild bilder braucht fehlen kein noch objekt objekte objekten zwei

import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import type { Page } from '@playwright/test';
import type { ClipTracks, Segmentation } from 'veronese';
import type { VeroneseSegmenterElement } from 'veronese/element';

import { clipFrames, clipInNode, differences, expect, labelsOfDavis, test, unwatched } from './support.js';
import { BIT, BITS, video } from './video.js';

/** Opens the host page without its own masks, and gives the page `clip(count)`, frames of a moving square as pixels. */
async function openEmpty(page: Page): Promise<void> {
  await page.route('**/samples/**', () => undefined); // its own frames never arrive
  await page.goto('./embed.html');
  await page.evaluate(() => {
    document.querySelector('veronese-segmenter')?.remove();
    const picture = (shift: number): ImageData => {
      const image = new ImageData(96, 64);
      for (let p = 0; p < 96 * 64; p++) {
        const [x, y] = [p % 96, Math.floor(p / 96)];
        const inside = x >= 30 + shift && x < 60 + shift && y >= 20 && y < 44;
        const [u, v] = inside ? [x - shift + 300, y + 90] : [x, y];
        const grey = 128 + 60 * Math.sin(0.5 * u + 0.2 * v) + 50 * Math.cos(0.4 * v - 0.15 * u);
        image.data.set([grey, grey, grey, 255], 4 * p);
      }
      return image;
    };
    Object.assign(window, { clip: (count: number) => Array.from({ length: count }, (_, k) => picture(2 * k)) });
  });
}

declare const clip: (count: number) => ImageData[];

test('its worker starts and warms up while the frames are on their way', async ({ page }) => {
  await openEmpty(page);
  const [first, second] = (await clipFrames(2)).map(({ buffer }) => buffer);
  const released: (() => void)[] = [];
  await page.route('**/held-*.png', async (route) => {
    await new Promise<void>((resolve) => released.push(resolve));
    await route.fulfill({ contentType: 'image/png', body: route.request().url().includes('first') ? first! : second! });
  });
  const worker = page.waitForEvent('worker');
  const result = page.evaluate(() => {
    document.body.insertAdjacentHTML('beforeend', '<veronese-segmenter first="held-first.png" second="held-second.png" quality="fast"></veronese-segmenter>');
    return new Promise((resolve) => document.querySelector('veronese-segmenter')!.addEventListener('result', ({ detail }) => resolve(detail.width)));
  });
  await worker;
  await expect.poll(() => released.length).toBe(2);
  for (const release of released) release();
  expect(await result).toBe(100);
});

test('a clip of files: the labels, objects and tracks of the package', async ({ page }) => {
  const files = await clipFrames(5);
  const expected = await clipInNode(files);
  await openEmpty(page);
  const found = await page.evaluate(async (frames) => {
    const element = document.createElement('veronese-segmenter');
    element.setAttribute('quality', 'fast');
    const told: { index: number; labels: number[]; ids: number[] }[] = [];
    const stages = new Set<string>();
    element.addEventListener('frame', ({ detail: { index, labels, objects } }) => told.push({ index, labels: [...labels], ids: objects.map(({ id }) => id) }));
    element.addEventListener('progress', ({ detail }) => stages.add('frame' in detail ? `${detail.stage} of ${detail.of}` : 'of a pair'));
    const ended = new Promise<ClipTracks>((resolve) => element.addEventListener('tracks', ({ detail }) => resolve(detail)));
    element.frames = frames.map((base64) => new Blob([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))]));
    document.body.append(element);
    const tracks = await ended;
    const again = element.tracks();
    return { told, stages: [...stages], tracks, same: JSON.stringify(again) === JSON.stringify(tracks), count: element.frameCount };
  }, files.map(({ buffer }) => buffer.toString('base64')));
  expect(found.told.map(({ index }) => index)).toEqual([0, 1, 2, 3, 4]);
  found.told.forEach(({ labels }, index) => expect(differences(labels, expected[index]!)).toBe(0));
  expect(found.stages).toEqual(['pairs of 5']);
  expect(found.tracks.objects.map(({ id }) => id)).toEqual([...new Set(found.told.flatMap(({ ids }) => ids))]);
  expect(found.tracks.objects.length).toBeGreaterThan(0);
  expect(found).toMatchObject({ same: true, count: 5 });
});

test('where nothing is found, why: to see and in the events, until there is something', async ({ page }) => {
  await openEmpty(page);
  const element = page.locator('veronese-segmenter');
  const told = await page.evaluate(async () => {
    const element = document.createElement('veronese-segmenter');
    element.setAttribute('quality', 'fast');
    document.body.append(element);
    const [first, second] = clip(2) as [ImageData, ImageData];
    const result = new Promise<Segmentation>((resolve) => element.addEventListener('result', ({ detail }) => resolve(detail)));
    await element.setFrames(first, first);
    const tracks = new Promise<ClipTracks>((resolve) => element.addEventListener('tracks', ({ detail }) => resolve(detail)));
    element.frames = [first, first, first];
    const all = [(await result).notes, (await tracks).notes, element.tracks()?.notes];
    Object.assign(window, { other: () => element.setFrames(first, second) });
    return all;
  });
  const note = { code: 'no-motion', message: 'nothing moves between the frames: their grey levels differ by 0.00 on average' };
  expect(told).toEqual([[note], [note], [note]]);
  await expect(element.getByRole('status')).toHaveText(note.message);
  await page.evaluate(() => (window as unknown as { other: () => Promise<void> }).other());
  await expect(element.getByRole('status', { includeHidden: true })).toHaveText('');
});

test('frames of every kind; those that cannot be used; abort and removal; a form', async ({ page }) => {
  await openEmpty(page);

  await test.step('frames of every kind give the same clip, and a stream can be looked at again', async () => {
    const found = await page.evaluate(async () => {
      const frames = clip(4);
      const element = document.createElement('veronese-segmenter');
      element.setAttribute('quality', 'fast');
      document.body.append(element);
      const segmented = (given: unknown): Promise<string> =>
        new Promise((resolve, reject) => {
          const all: string[] = [];
          const listen = new AbortController();
          const { signal } = listen;
          element.addEventListener('frame', ({ detail }) => all.push(String(detail.labels)), { signal });
          element.addEventListener('error', ({ detail }) => reject(detail), { signal });
          element.addEventListener('tracks', () => (listen.abort(), resolve(all.join())), { signal });
          element.frames = given as ImageData[];
        });
      const bitmaps = await Promise.all(frames.map((frame) => createImageBitmap(frame)));
      async function* stream(): AsyncGenerator<ImageData> {
        const buffer = new ImageData(96, 64); // one for all frames
        for (const frame of frames) {
          buffer.data.set(frame.data);
          yield buffer;
        }
      }
      const whole = await segmented(frames);
      const same = [
        (await segmented({ length: 4, read: async (index: number) => frames[index] })) === whole,
        (await segmented(bitmaps)) === whole,
      ];
      const streamed = await segmented(stream());
      const [again, last] = [(await segmented(frames.values())) === streamed, element.currentFrame];
      // The picture of a frame that came once, read back: the same but for compression.
      element.currentFrame = 1;
      await new Promise((resolve) => element.addEventListener('show', resolve, { once: true }));
      const { data } = element.shadowRoot!.querySelector<HTMLCanvasElement>('.frame')!.getContext('2d')!.getImageData(0, 0, 96, 64);
      const error = data.reduce((sum, value, at) => sum + Math.abs(value - frames[1]!.data[at]!), 0) / data.length;
      element.remove();
      return { same, again, last, error };
    });
    expect(found).toMatchObject({ same: [true, true], again: true, last: 3 });
    expect(found.error).toBeLessThan(8);
  });

  await test.step('two frames are copied; events tell of them, and they can be cancelled', async () => {
    const found = await page.evaluate(async () => {
      const element = document.createElement('veronese-segmenter');
      element.setAttribute('quality', 'fast');
      document.body.append(element);
      const events: string[] = [];
      for (const type of ['progress', 'result', 'error']) element.addEventListener(type, (event) => events.push(`${type} ${(event as CustomEvent<{ code?: string }>).detail.code ?? ''}`.trim()));
      const code = (promise: Promise<unknown>): Promise<string> => promise.then(() => 'answered', ({ code }: { code: string }) => code);
      const [first, second] = clip(2) as [ImageData, ImageData];
      const expected = (await element.setFrames(first, second)).labels;
      const bitmaps = await Promise.all(clip(2).map((frame) => createImageBitmap(frame)));
      const answers: Uint8Array[] = [];
      for (const [one, other] of [clip(2), bitmaps] as [ImageData | ImageBitmap, ImageData | ImageBitmap][]) {
        const answer = element.setFrames(one, other);
        for (const frame of [one, other]) frame instanceof ImageData ? frame.data.fill(7) : frame.close();
        answers.push((await answer).labels);
        // The element segments them again when an attribute changes.
        answers.push(((await element.segment()) as Segmentation).labels);
      }
      const same = answers.map((labels) => String(labels) === String(expected));
      const cancelled = code(element.setFrames(first, second));
      element.abort();
      const gone = clip(1)[0]!;
      structuredClone(gone.data.buffer, { transfer: [gone.data.buffer] });
      const codes = [await cancelled];
      for (const wrong of [null, undefined, 5, {}, [], { data: [1], width: 16, height: 16 }, gone, bitmaps[0], new Blob(['text'])]) {
        codes.push(await code(element.setFrames(first, wrong as ImageData)));
      }
      for (const [name, value] of [['motions', 'two'], ['motions', '99'], ['quality', 'good']] as const) {
        element.setAttribute(name, value);
        codes.push(await code(element.setFrames(first, second)));
        element.removeAttribute(name);
      }
      const { length } = (await element.setFrames(first, second)).labels;
      element.remove();
      return { events: [...new Set(events)], same, codes, length };
    });
    const wrong = [...Array<string>(8).fill('invalid-input'), 'unreadable-image', ...Array<string>(3).fill('invalid-option')];
    expect(found).toEqual({ events: ['progress', 'result', ...[...new Set(wrong)].map((code) => `error ${code}`)], same: [true, true, true, true], codes: ['cancelled', ...wrong], length: 96 * 64 });
  });

  await test.step('frames that cannot be used are errors with a code', async () => {
    const { codes, before } = await page.evaluate(async () => {
      const element = document.createElement('veronese-segmenter');
      element.setAttribute('quality', 'fast');
      document.body.append(element);
      const codes: string[] = [];
      const code = (): Promise<string> => new Promise((resolve) => element.addEventListener('error', ({ detail }) => resolve(detail.code), { once: true }));
      const [first, second] = clip(2);
      for (const given of [5, {}, [first, null], [first, new ImageData(32, 32)], [new Blob(['text'])], { length: 'two', read: () => first }, [first, 'embed.html']]) {
        const told = code();
        element.frames = given as ImageData[];
        codes.push(await told);
      }
      const told = code();
      element.src = URL.createObjectURL(new Blob(['no video']));
      codes.push(await told);
      // The frames before one of them are done.
      const before: unknown[] = [];
      for (const type of ['frame', 'tracks', 'error'] as const) element.addEventListener(type, ({ detail }) => before.push('index' in detail ? detail.index : type));
      const failed = code();
      element.frames = [...clip(3), null!];
      before.push(await failed, element.frameCount, element.checkValidity());
      // It goes on.
      const tracks = new Promise((resolve) => element.addEventListener('tracks', resolve, { once: true }));
      element.frames = [first!, second!];
      await tracks;
      return { codes, before: before.slice(0, 7) };
    });
    expect(before).toEqual([0, 1, 2, 'error', 'invalid-input', 3, false]);
    expect(codes).toEqual(['invalid-input', 'invalid-input', 'invalid-input', 'frame-size-mismatch', 'unreadable-image', 'invalid-input', 'unreadable-image', 'unreadable-video']);
  });

  await test.step('abort keeps what is done; other frames and removal cancel and close the source', async () => {
    const found = await page.evaluate(async () => {
      const frames = clip(6);
      const form = document.createElement('form');
      const element = document.createElement('veronese-segmenter');
      element.setAttribute('quality', 'fast');
      element.name = 'masks';
      form.append(element);
      document.body.append(form);
      let closed = 0;
      async function* endless(): AsyncGenerator<ImageData> {
        try {
          for (let k = 0; ; k++) yield frames[Math.abs((k % 10) - 5)]!;
        } finally {
          closed += 1;
        }
      }
      const frame = (index: number): Promise<void> =>
        new Promise((resolve) => {
          const listen = new AbortController();
          element.addEventListener('frame', ({ detail }) => {
            if (detail.index < index) return;
            listen.abort();
            resolve();
          }, { signal: listen.signal });
        });
      const until = async (holds: () => boolean): Promise<void> => {
        while (!holds()) await new Promise((resolve) => setTimeout(resolve, 20));
      };
      element.frames = endless();
      await frame(2);
      element.abort();
      const kept = element.frameCount;
      await until(() => closed === 1);
      await until(() => new FormData(form).getAll('masks').length === kept);
      const stays = element.frameCount === kept && element.checkValidity();
      element.frames = endless();
      await frame(0);
      const tracks = new Promise((resolve) => element.addEventListener('tracks', resolve, { once: true }));
      element.frames = frames;
      await tracks;
      await until(() => closed === 2);
      const whole = element.frameCount;
      element.frames = endless();
      await frame(0);
      form.remove();
      await until(() => closed === 3);
      return { kept, stays, whole };
    });
    expect(found.kept).toBeGreaterThanOrEqual(3);
    expect(found).toMatchObject({ stays: true, whole: 6 });
  });

  await test.step('a form carries the masks, and waits for them', async () => {
    const found = await page.evaluate(async () => {
      document.body.innerHTML = '<form><fieldset><veronese-segmenter name="masks" quality="fast" grouped required></veronese-segmenter></fieldset></form>';
      const form = document.querySelector('form')!;
      const element = document.querySelector('veronese-segmenter') as VeroneseSegmenterElement;
      const once = (name: string): Promise<unknown> => new Promise((resolve) => element.addEventListener(name, resolve, { once: true }));
      const valid = (): string[] => [String(form.checkValidity()), element.validationMessage];
      const carried = (): string[] => [...new FormData(form)].map(([name, file]) => `${name} ${(file as File).name} ${(file as File).type}`);
      const missing = [...valid(), String(element.validity.valueMissing)];
      const [first, second] = clip(2);
      const result = element.setFrames(first!, second!);
      const busy = valid();
      await result;
      const pair = [...carried(), ...valid()];
      const file = new FormData(form).get('masks') as File;
      const labels = { png: [...new Uint8Array(await file.arrayBuffer())], labels: [...element.labels()!] };
      const tracks = once('tracks');
      element.frames = clip(3);
      await tracks;
      const whole = [...carried(), ...valid()];
      const frames = await Promise.all(new FormData(form).getAll('masks').map(async (one) => [...new Uint8Array(await (one as File).arrayBuffer())]));
      const shown: number[][] = [];
      for (const index of [2, 1, 0]) {
        element.currentFrame = index;
        await once('show');
        shown[index] = [...element.labels()!];
      }
      element.name = 'others';
      const renamed = carried();
      element.currentFrame = 2;
      element.selected = 1;
      await once('show');
      form.reset();
      const reset = [element.currentFrame, element.selected, element.form === form];
      document.querySelector('fieldset')!.disabled = true;
      const disabled = [carried().length, element.willValidate, element.disabled, element.shadowRoot!.querySelector('input')!.disabled];
      document.querySelector('fieldset')!.disabled = false;
      const failed = once('error');
      element.frames = [first!, new ImageData(32, 32)];
      await failed;
      return { missing, busy, pair, labels, whole, frames, shown, renamed, reset, disabled, failed: valid() };
    });
    expect(found.missing).toEqual(['false', 'Frames are missing.', 'true']);
    expect(found.busy).toEqual(['false', 'The masks are not ready yet.']);
    expect(found.pair).toEqual(['masks labels.png image/png', 'true', '']);
    expect(found.whole).toEqual([...['00000.png', '00001.png', '00002.png'].map((name) => `masks ${name} image/png`), 'true', '']);
    expect(found.renamed).toEqual(['00000.png', '00001.png', '00002.png'].map((name) => `others ${name} image/png`));
    expect(found.reset).toEqual([0, null, true]);
    expect(found.disabled).toEqual([0, false, false, true]);
    expect(found.failed).toEqual(['false', expect.stringContaining('32×32')]);
    // Read by another decoder, the files have the labels.
    const pictures = [[found.labels.png, found.labels.labels], ...found.frames.map((png, index) => [png, found.shown[index]!])] as [number[], number[]][];
    for (const [png, labels] of pictures) expect(differences(await labelsOfDavis(Uint8Array.from(png)), labels)).toBe(0);
  });
});

// Addresses that lead nowhere are complained of.
unwatched('says what happened, in words that a page may replace', async ({ page }) => {
  await openEmpty(page);
  await page.route('**/missing.*', (route) => route.fulfill({ status: 404, contentType: 'text/html', body: '<!doctype html>' }));
  const found = await page.evaluate(async () => {
    const said: Record<string, string> = {};
    const [frame] = clip(1);
    const failing = (name: string, give: (element: VeroneseSegmenterElement) => void): Promise<void> =>
      new Promise((resolve) => {
        const element = document.createElement('veronese-segmenter');
        element.addEventListener('error', ({ detail: { code, message } }) => {
          said[name] = `${code}: ${message}`;
          element.remove();
          resolve();
        });
        document.body.append(element);
        give(element);
      });
    const address = './embed.html';
    await failing('missing', (element) => {
      element.setAttribute('second', address);
      element.setAttribute('first', 'missing.png');
    });
    await failing('text', (element) => {
      element.setAttribute('second', address);
      element.setAttribute('first', address);
    });
    await failing('video', (element) => element.setAttribute('src', 'missing.mp4'));
    await failing('motions', (element) => {
      element.setAttribute('motions', 'zz');
      void element.setFrames(frame!, frame!).catch(() => undefined);
    });
    await failing('none', (element) => (element.frames = []));
    await failing('one', (element) => (element.frames = [frame!]));
    await failing('one of a stream', (element) => (element.frames = [frame!].values()));
    return said;
  });
  const address = (name: string): string => new URL(name, page.url()).href;
  expect(found).toEqual({
    missing: `unreadable-image: the first frame cannot be loaded: ${address('missing.png')} answered 404 Not Found`,
    text: 'unreadable-image: the first frame is not an image that this browser can read',
    video: `unreadable-video: the clip cannot be loaded: ${address('missing.mp4')} answered 404 Not Found`,
    motions: "invalid-option: option 'motions': must be 'auto' or a whole number from 1 to 10, not 'zz'",
    none: 'too-few-frames: a clip needs two frames, found none',
    one: 'too-few-frames: a clip needs two frames, found one',
    'one of a stream': 'too-few-frames: a clip needs two frames, found one',
  });

  await page.evaluate(async () => {
    const element = document.createElement('veronese-segmenter');
    element.setAttribute('quality', 'fast');
    element.toggleAttribute('required');
    document.body.append(element);
    element.messages = {
      noFrame: 'noch kein Bild',
      frame: (number, of, objects) => `Bild ${number} von ${of} mit ${objects} Objekten`,
      objects: 'Objekte',
      object: (number) => `Objekt ${number}`,
      timeline: 'Bild',
      time: (number, of) => `Bild ${number} von ${of}`,
      missing: 'Es fehlen Bilder.',
      error: ({ code }) => (code === 'too-few-frames' ? 'Ein Film braucht zwei Bilder.' : code),
    };
  });
  const element = page.locator('veronese-segmenter');
  await expect(element.getByRole('img')).toHaveAccessibleName('noch kein Bild');
  expect(await element.evaluate((one: VeroneseSegmenterElement) => one.validationMessage)).toBe('Es fehlen Bilder.');
  await element.evaluate((one: VeroneseSegmenterElement) => (one.frames = clip(1)));
  await expect(element.getByRole('status')).toHaveText('Ein Film braucht zwei Bilder.');
  await element.evaluate((one: VeroneseSegmenterElement) => (one.frames = clip(3)));
  await expect(element.getByRole('img')).toHaveAccessibleName('Bild 1 von 3 mit 1 Objekten');
  await expect(element.getByRole('listbox')).toHaveAccessibleName('Objekte');
  await expect(element.getByRole('option')).toHaveAccessibleName('Objekt 1');
  await expect(element.getByRole('slider')).toHaveAccessibleName('Bild');
  await expect(element.getByRole('slider')).toHaveAttribute('aria-valuetext', 'Bild 1 von 3');
  await element.evaluate((one: VeroneseSegmenterElement) => (one.messages = null));
  await expect(element.getByRole('option')).toHaveAccessibleName('Object 1');
  await expect(element.getByRole('img')).toHaveAccessibleName('frame 1 of 3 with the masks of 1 object');
});

test('the clip of the element takes annotations: what it shows, its events and a form follow', async ({ page }) => {
  await openEmpty(page);
  const found = await page.evaluate(async () => {
    const workers: Worker[] = [];
    window.Worker = class extends Worker {
      constructor(...given: ConstructorParameters<typeof Worker>) {
        super(...given);
        workers.push(this);
      }
    };
    document.body.innerHTML = '<form><veronese-segmenter name="masks" quality="fast"></veronese-segmenter></form>';
    const form = document.querySelector('form')!;
    const element = document.querySelector('veronese-segmenter') as VeroneseSegmenterElement;
    const once = (type: string): Promise<unknown> => new Promise((resolve) => element.addEventListener(type, resolve, { once: true }));
    const codeOf = (step: PromiseLike<unknown>): Promise<string> => Promise.resolve(step).then(() => 'answered', ({ code }: { code: string }) => code);
    const sizes = (): string => String(new FormData(form).getAll('masks').map((file) => (file as File).size));
    const before = once('tracks');
    element.frames = clip(6);
    const early = element.clip;
    await before;
    const opened = element.clip!;
    const told: string[] = [];
    for (const type of ['frame', 'tracks', 'error'] as const) {
      element.addEventListener(type, ({ detail }) => told.push('index' in detail ? `${type} ${detail.index}` : type));
    }
    const [labels, files, ids] = [String(element.labels()), sizes(), () => element.tracks()!.objects.map(({ id }) => id)];
    const map = (label: number): Uint8Array =>
      Uint8Array.from({ length: 96 * 64 }, (_, p) => {
        const [x, y] = [p % 96, Math.floor(p / 96)];
        return x >= 30 && x < 60 && y >= 20 && y < 44 ? label : 0;
      });

    // The frame that is shown is right before the annotation has spread; the form waits until it has.
    const annotated = once('tracks');
    let isSpread = false;
    const step = opened.annotate({ frame: 0, labels: map(9) });
    const spread = step.then((changes) => ((isSpread = true), [...new Set(changes.map(({ frame }) => frame))]));
    await once('show');
    const drawn = [String(element.labels()) === String(map(9)), isSpread, told.length, form.checkValidity()];
    const changed = await spread;
    await annotated;
    const after = { changed, told: told.splice(0), ids: ids(), valid: form.checkValidity(), carried: sizes() !== files };

    // Undone and done again: it is drawn, told and carried as it was.
    const moved = async (what: 'undo' | 'redo'): Promise<unknown> => {
      const tracks = once('tracks');
      await opened[what]();
      await tracks;
      return { told: told.splice(0), ids: ids(), first: String(element.labels()) === labels, files: sizes() === files };
    };
    const undone = await moved('undo');
    const redone = await moved('redo');
    await moved('undo');

    // A lock changes no frame; what fails, and what is aborted, changes nothing.
    const locked = once('tracks');
    await opened.lock([1]);
    await locked;
    const alone = told.splice(0);
    const refused = await codeOf(opened.annotate({ frame: 0, object: 1, mask: map(1) }));
    const wrong = await codeOf(opened.annotate({ frame: 6, labels: map(5) }));
    const aborted = codeOf(opened.annotate({ frame: 0, labels: map(5) }));
    await once('progress');
    element.abort();
    const codes = [refused, wrong, await aborted];
    while (!element.checkValidity()) await new Promise((resolve) => setTimeout(resolve, 10));
    const unchanged = { codes, told: told.splice(0), same: String(element.labels()) === labels && sizes() === files };

    // An attribute that changes segments the same clip again, with what was annotated; a frame that is not shown is told.
    const spoken = once('tracks');
    await opened.annotate({ frame: 3, object: 7, mask: map(1), propagate: 'none' });
    await spoken;
    const again = once('tracks');
    element.setAttribute('motions', '2');
    await again;
    const kept = [element.clip === opened, ids(), opened.frames.map(({ annotated }) => annotated).indexOf(true)];

    // All workers are lost: the clip goes on in another one.
    told.splice(0);
    for (const worker of workers) worker.dispatchEvent(new ErrorEvent('error', { message: 'gone' }));
    const revived = once('tracks');
    await opened.annotate({ frame: 0, object: 9, mask: new Uint8Array(96 * 64).fill(1, 0, 960), propagate: 'none' });
    await revived;
    const lost = [told.splice(0), element.labels()![0]];

    // Other frames and removal close it.
    element.frames = clip(2);
    const closed = [element.clip, await codeOf(opened.labels(0))];
    await once('tracks');
    const second = element.clip!;
    form.remove();
    closed.push(element.clip, await codeOf(second.labels(0)));
    document.body.append(element);
    await once('tracks');
    const third = element.clip !== second && element.frameCount === 2;
    element.frames = clip(3).values();
    await once('tracks');
    return { early, drawn, after, undone, redone, alone, unchanged, kept, lost, closed, third, stream: element.clip };
  });
  const frames = [0, 1, 2, 3, 4, 5];
  const told = [...frames.map((index) => `frame ${index}`), 'tracks'];
  expect(found).toEqual({
    early: undefined,
    drawn: [true, false, 0, false],
    after: { changed: frames, told, ids: [9], valid: true, carried: true },
    undone: { told, ids: [1], first: true, files: true },
    redone: { told, ids: [9], first: false, files: false },
    alone: ['tracks'],
    unchanged: { codes: ['object-locked', 'invalid-option', 'cancelled'], told: [], same: true },
    kept: [true, [1, 7], 3],
    lost: [['frame 0', 'tracks'], 9],
    closed: [undefined, 'clip-closed', undefined, 'clip-closed'],
    third: true,
    stream: undefined,
  });
});

test('the keyboard steps through frames and chooses objects', async ({ page }) => {
  await openEmpty(page);
  await page.evaluate(async () => {
    document.body.innerHTML = '<main><h1>Test</h1><label><input type="checkbox" id="before" /> Before</label></main>';
    const element = document.createElement('veronese-segmenter');
    element.setAttribute('quality', 'fast');
    const chosen: unknown[] = [];
    element.addEventListener('select', ({ detail }) => chosen.push(detail));
    Object.assign(window, { chosen, element });
    const tracks = new Promise((resolve) => element.addEventListener('tracks', resolve));
    element.frames = clip(4);
    document.querySelector('main')!.append(element);
    await tracks;
    await new Promise((resolve) => setTimeout(resolve));
  });
  const state = (): Promise<unknown> =>
    page.evaluate(() => {
      const { chosen, element } = window as unknown as { chosen: unknown[]; element: VeroneseSegmenterElement };
      return { frame: element.currentFrame, selected: element.selected, chosen };
    });
  const list = page.getByRole('listbox', { name: 'Objects' });
  const picture = page.getByRole('img', { name: /^frame \d of 4 with the masks of 1 object$/ });
  await expect(picture).toHaveAccessibleName(/^frame 1/);
  await page.locator('#before').focus();
  await page.keyboard.press('Tab');
  await expect(list).toBeFocused();
  expect(await list.evaluate((element) => getComputedStyle(element).outlineStyle)).toBe('solid');
  await page.keyboard.press('ArrowDown');
  await expect(page.getByRole('option', { name: 'Object 1', selected: true })).toBeAttached();
  expect(await list.getAttribute('aria-activedescendant')).toBe(await page.getByRole('option').getAttribute('id'));
  await page.keyboard.press('ArrowRight');
  await expect(picture).toHaveAccessibleName(/^frame 2/);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowLeft');
  expect(await state()).toEqual({ frame: 1, selected: 1, chosen: [1] });
  await page.keyboard.press('Escape');
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowLeft');
  expect(await state()).toEqual({ frame: 0, selected: null, chosen: [1, null] });
  await page.keyboard.press('Tab');
  const slider = page.getByRole('slider', { name: 'Frame' });
  await expect(slider).toBeFocused();
  await page.keyboard.press('End');
  await expect(slider).toHaveAttribute('aria-valuetext', 'frame 4 of 4');
  await expect(picture).toHaveAccessibleName(/^frame 4/);
  // A click chooses what is under it, or nothing.
  const box = (await list.boundingBox())!;
  await list.click({ position: { x: (50.5 / 96) * box.width, y: (32.5 / 64) * box.height } });
  expect(await state()).toMatchObject({ selected: 1 });
  await list.click({ position: { x: 4, y: 4 } });
  expect(await state()).toMatchObject({ selected: null });
});

test('with controls it plays, has a legend and zooms; without it has none of them', async ({ page }) => {
  await openEmpty(page);
  await page.evaluate(async () => {
    document.body.innerHTML = '<main><h1>Test</h1></main>';
    const element = document.createElement('veronese-segmenter');
    element.setAttribute('quality', 'fast');
    element.messages = { pause: 'Halt' };
    const tracks = new Promise((resolve) => element.addEventListener('tracks', resolve));
    element.frames = clip(5);
    document.querySelector('main')!.append(element);
    await tracks;
  });
  const element = page.locator('veronese-segmenter');
  const play = element.locator('[part=play]');
  await expect(play).toBeHidden();
  await expect(element.locator('[part=legend]')).toBeHidden();
  const width = (): Promise<number> => element.locator('[part=frame]').evaluate((frame) => Math.round(frame.getBoundingClientRect().width));
  const whole = await width();
  const list = element.getByRole('listbox');
  await list.hover();
  await page.mouse.wheel(0, -240);
  expect(await width()).toBe(whole);

  await element.evaluate((one) => one.setAttribute('controls', 'play legend zoom'));
  const number = element.locator('[part=number]');
  await expect(number).toHaveText('frame 1 of 5');
  await play.click();
  await expect(play).toHaveText('Halt');
  await expect(number).toHaveText('frame 5 of 5');
  await expect(play).toHaveText('Play');
  await play.click();
  await expect(number).toHaveText('frame 5 of 5');
  // The colour is that of the page's style sheet.
  await element.locator('[part=entry]', { hasText: 'Object 1' }).click();
  await expect(element.getByRole('option', { name: 'Object 1', selected: true })).toBeAttached();
  expect(await element.locator('[part=swatch]').evaluate((swatch) => getComputedStyle(swatch).backgroundColor)).toBe('rgb(255, 92, 147)');

  // Twice as large; what is under the pointer stays there, and is chosen as before.
  await list.press('Escape');
  const stage = (await element.locator('[part=stage]').boundingBox())!;
  const at = { x: stage.x + (50 / 96) * stage.width, y: stage.y + (32 / 64) * stage.height };
  await page.mouse.move(at.x, at.y);
  await page.mouse.wheel(0, -240);
  await expect.poll(width).toBe(2 * whole);
  await page.mouse.click(at.x, at.y);
  await expect(element.getByRole('option', { name: 'Object 1', selected: true })).toBeAttached();
  await list.press('+');
  await expect.poll(width).toBe(4 * whole);
  await list.press('0');
  await expect.poll(width).toBe(whole);
});

test('every frame of a video, 30 and 12.5 a second', { tag: '@soak' }, async ({ page }) => {
  await openEmpty(page);
  for (const [count, fps] of [[9, 30], [5, 12.5]] as const) {
    const { buffer } = await video(page, count, 'webm', 'vp8', fps === 30 ? undefined : 1 / fps);
    const read = await page.evaluate(async ([base64, row]) => {
      const element = document.createElement('veronese-segmenter');
      element.setAttribute('quality', 'fast');
      document.body.append(element);
      const tracks = new Promise((resolve, reject) => {
        element.addEventListener('tracks', resolve);
        element.addEventListener('error', ({ detail }) => reject(detail));
      });
      element.src = URL.createObjectURL(new Blob([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], { type: 'video/webm' }));
      await tracks;
      const pictures: number[][] = [];
      for (let index = element.frameCount - 1; index >= 0; index--) {
        if (index !== element.currentFrame) {
          const shown = new Promise((resolve) => element.addEventListener('show', resolve, { once: true }));
          element.currentFrame = index;
          await shown;
        }
        const canvas = element.shadowRoot!.querySelector<HTMLCanvasElement>('.frame')!;
        pictures[index] = [...canvas.getContext('2d')!.getImageData(0, row, canvas.width, 1).data];
      }
      element.remove();
      return pictures;
    }, [buffer.toString('base64'), 8 + BIT / 2] as const);
    const numbers = read.map((data) => {
      const bit = (b: number): number => Number(data[4 * (8 + b * BIT + BIT / 2)]! > 128);
      return Array.from({ length: BITS }, (_, b) => bit(b) << b).reduce((sum, value) => sum + value, 0);
    });
    expect(numbers).toEqual(Array.from({ length: count }, (_, index) => index));
  }
});

// The examples of the package's README, in a page that loads the package without a bundler.

unwatched('the examples of README.md', async ({ page, context }) => {
  const root = fileURLToPath(new URL('../../', import.meta.url));
  const readme = await readFile(join(root, 'pkg/README.md'), 'utf8');
  const examples = [...readme.matchAll(/^```html element\n([\s\S]*?)^```$/gm)].map(([, code]) => code!);
  expect(examples).toHaveLength(2);
  const frames = (await clipFrames(4)).map(({ buffer }) => buffer);
  const pictures = new Map([['first.png', frames[0]!], ['second.png', frames[1]!], ...frames.map((frame, index) => [`f${index}.png`, frame] as const)]);
  const map = JSON.stringify({ imports: { 'veronese/element': './pkg/dist/element.js' } });
  const asked: string[] = [];
  await context.route('**/readme/**', (route) => {
    const path = new URL(route.request().url()).pathname.replace('/readme/', '');
    asked.push(path);
    const example = examples[Number(/^(\d)\.html$/.exec(path)?.[1])];
    if (example !== undefined) return route.fulfill({ contentType: 'text/html; charset=utf-8', body: `<!doctype html><link rel="icon" href="data:," /><script type="importmap">${map}</script>${example}` });
    const picture = pictures.get(path);
    return route.fulfill(picture ? { contentType: 'image/png', body: picture } : { path: join(root, path) });
  });
  const logged: string[] = [];
  page.on('console', (message) => logged.push(message.text()));
  page.on('pageerror', (error) => logged.push(String(error)));
  await page.goto('./readme/0.html');
  await expect(page.getByRole('img', { name: /masks of \d motions?$/ })).toBeAttached();
  // Two frames without a form load nothing that is for clips and files.
  expect(asked.filter((path) => path.includes('later'))).toEqual([]);
  expect(logged).toEqual([]);
  await page.goto('./readme/1.html');
  await expect(page).toHaveTitle(/^\d+ objects$/);
  await page.getByRole('button', { name: 'Save' }).click();
  await expect.poll(() => logged.at(-1)).toBe('00000.png 00001.png 00002.png 00003.png');
  expect(logged.slice(0, 4).map((line) => line.split(' ')[0])).toEqual(['0', '1', '2', '3']);
});
