//! Exports of whole clips: files are downloaded and compared with the masks on screen.

import { unzipSync } from 'fflate';

import { clipDone, clipFrames, differences, enter, expect, give, labelsInPalette, labelsOfDavis, masksOf, openClip, openExport, openSegmented, pixelsOfPicture, savedClip, segmentClip, test } from './support.js';

const text = (bytes: Uint8Array | undefined): string => new TextDecoder().decode(bytes);

test('a clip is exported in the formats of annotation tools, with the objects that are ticked; the preview shows one frame as its file has it', async ({ page }) => {
  const files = await clipFrames(4);
  await openSegmented(page, files);
  const found = await masksOf(page, [0, 1, 2, 3]);

  await test.step('the preview lists the files that are written, and shows one frame as they have it', async () => {
    const preview = page.locator('#clip-preview');
    const caption = preview.locator('figcaption');
    const listed = preview.locator('li');
    await openExport(page);
    const formats = page.getByLabel('Format of the clip');
    // An indexed PNG for each frame, under the frame's name.
    const davis = unzipSync((await savedClip(page, 'DAVIS')).bytes);
    const folder = 'davis/Annotations/480p/f00_to_f03';
    expect(Object.keys(davis)).toEqual([...files.map((file) => `${folder}/${file.name}`), 'davis/ImageSets/2017/val.txt']);
    for (const [index, file] of files.entries()) expect(differences(await labelsOfDavis(davis[`${folder}/${file.name}`]!), found[index]!)).toBe(0);
    await expect(listed).toHaveText([`${folder}/f00.png … f03.png, 4 files`, 'davis/ImageSets/2017/val.txt']);
    await expect(caption).toHaveText(`f03.png: ${davis[`${folder}/f03.png`]!.length} B`);
    const shown = async (): Promise<Uint8Array> => labelsInPalette(await pixelsOfPicture(preview.locator('img')));
    expect(differences(await shown(), found[3]!)).toBe(0);

    await formats.selectOption({ label: 'YOLO segmentation' });
    await expect(listed).toHaveText(['yolo/labels/f00.txt … f03.txt, 4 files', 'yolo/names.txt … data.yaml, 2 files']);
    const yolo = unzipSync((await savedClip(page, 'YOLO segmentation')).bytes);
    const beginning = (await preview.locator('pre').textContent())!.replace(/…$/, '');
    expect(beginning.length).toBeGreaterThan(40);
    expect(text(yolo['yolo/labels/f03.txt']).startsWith(beginning)).toBe(true);

    await formats.selectOption({ label: 'MOTS' });
    await expect(listed).toHaveText(['mots/gt/gt.txt … labels.txt, 2 files', 'mots/seqinfo.ini']);
    await expect(preview.locator('pre')).toHaveText(/^1 1001 1 70 100 /);
    await formats.selectOption({ label: 'YouTube-VIS' });
    await expect(preview.locator('pre')).toContainText('"videos":');
    await expect(caption).toHaveText(/^youtube-vis\.json with frame 3 alone: \d/);

    // Objects that are not ticked are not shown.
    await page.keyboard.press('Escape');
    await page.getByLabel('Show Object 2').uncheck();
    await openExport(page);
    await formats.selectOption({ label: 'DAVIS' });
    await expect(caption).toContainText('f03.png');
    await expect.poll(async () => differences(await shown(), found[3]!.map((label) => (label === 2 ? 0 : label)))).toBe(0);
    await page.keyboard.press('Escape');
    await page.getByLabel('Show Object 1').uncheck();
    await openExport(page);
    await expect(caption).toHaveText('Tick an object in the list first.');
    await expect(listed).toHaveCount(0);
  });
  await page.keyboard.press('Escape');
  for (const object of [1, 2]) await page.getByLabel(`Show Object ${object}`).check();

  const name = page.locator('#objects .motion-name').nth(1);
  await enter(name, 'Ball');

  const vis = JSON.parse((await savedClip(page, 'YouTube-VIS')).bytes.toString()) as {
    videos: { file_names: string[] }[];
    categories: { name: string }[];
    annotations: { areas: (number | null)[] }[];
  };
  expect(vis.videos[0]!.file_names).toEqual(files.map((file) => file.name));
  expect(vis.categories.map(({ name }) => name).sort()).toEqual(['Ball', 'object']);
  const pixels = (object: number): number[] => found.map((labels) => labels.filter((label) => label === object).length);
  expect(vis.annotations.map(({ areas }) => areas)).toEqual([pixels(1), pixels(2)]);

  // Objects that are not ticked are left out.
  await page.keyboard.press('Escape');
  await page.getByLabel('Show Object 2').uncheck();
  const cvat = (await savedClip(page, 'CVAT, tracks')).bytes.toString();
  expect([...cvat.matchAll(/<track [^>]*label="([^"]*)"/g)].map(([, label]) => label)).toEqual(['Ball']);
  expect([...cvat.matchAll(/<polygon frame="(\d+)"[^>]*outside="0"/g)].map(([, frame]) => Number(frame))).toEqual([0, 1, 2, 3]);

  const mots = unzipSync((await savedClip(page, 'MOTS')).bytes);
  expect(text(mots['mots/gt/labels.txt'])).toBe('Ball\n');
  expect(text(mots['mots/gt/gt.txt']).trim().split('\n')).toHaveLength(4);

  const yolo = unzipSync((await savedClip(page, 'YOLO segmentation')).bytes);
  expect(Object.keys(yolo)).toEqual([...files.map((file) => `yolo/labels/${file.name.replace('.png', '.txt')}`), 'yolo/names.txt', 'yolo/data.yaml']);
  expect(text(yolo['yolo/labels/f03.txt'])).toMatch(/^0( \d[\d.e-]*){6,}\n$/);

  const tasks = JSON.parse((await savedClip(page, 'Label Studio')).bytes.toString()) as { data: { image: string }; predictions: { result: unknown[] }[] }[];
  expect(tasks.map(({ data }) => data.image.replace(/^.*\//, ''))).toEqual(files.map((file) => file.name));
  expect(tasks.map(({ predictions }) => predictions[0]!.result.length)).toEqual([1, 1, 1, 1]);
  await expect(page.locator('#clip-export-status')).toHaveText('Saved: one object in 4 frames.');

  const coco = JSON.parse((await savedClip(page, 'COCO, RLE')).bytes.toString()) as { images: unknown[]; annotations: { attributes: { track_id: number } }[] };
  expect(coco.images).toHaveLength(4);
  expect(coco.annotations.map(({ attributes }) => attributes.track_id)).toEqual([1, 1, 1, 1]);

  // Nothing ticked, nothing saved.
  await page.keyboard.press('Escape');
  await page.getByLabel('Show Ball').uncheck();
  await openExport(page);
  await page.getByRole('button', { name: 'Save clip' }).click();
  await expect(page.locator('#notice')).toContainText('Tick an object in the list first.');
});

test('objects have classes of a list: given by keyboard, undone, exported with the numbers of the list, and imported again', async ({ page }) => {
  await openClip(page, await clipFrames(4));
  const notice = page.locator('#notice-sentence');
  const file = (name: string, content: string) => ({ name, mimeType: 'text/plain', buffer: Buffer.from(content) });
  await give(page, 'drop', [file('labels.json', JSON.stringify([{ name: 'person', color: '#ff0000' }, { name: 'ball' }]))]);
  await expect(notice).toHaveText('2 classes added to the list.');
  await segmentClip(page);
  // It is kept for the next clip, though it was read before there was a list of objects.
  await expect.poll(() => page.evaluate(() => localStorage.getItem('veronese-classes'))).toBe('["person","ball"]');
  const categories = [{ id: 8, name: 'box' }, { id: 3, name: 'ball' }];
  await give(page, 'drop', [file('categories.json', JSON.stringify({ images: [], annotations: [], categories }))]);
  await expect(notice).toHaveText('One class added to the list.');
  // The dialogue says what is no list of classes, and adds nothing.
  const list = page.locator('#class-list');
  const told = list.getByRole('status');
  await page.keyboard.press('1');
  await page.getByRole('button', { name: 'Classes…' }).click();
  // Keys are not about the object behind it.
  await list.getByRole('button', { name: 'Done' }).focus();
  await page.keyboard.press('Delete');
  await expect(page.locator('#undo')).toBeDisabled();
  await list.locator('input').setInputFiles([file('label.txt', '0 0.25 0.5 0.75 0.5\n')]);
  await expect(told).toHaveText(/^“label\.txt” is no list of classes/);
  await list.locator('input').setInputFiles([file('names.txt', '\ufeffperson\r\ntree\r\n')]);
  await expect(told).toHaveText('One class added to the list.');
  const lines = list.getByRole('textbox', { name: 'Classes' });
  await expect(lines).toHaveValue('person\nball\nbox\ntree');
  await lines.fill('person\nbox\nball\n\nbox\n');
  await list.getByRole('button', { name: 'Done' }).click();
  await expect(page.locator('#class-names option')).toHaveText(['person', 'box', 'ball']);

  const names = page.locator('#objects .motion-name');
  const classify = async (object: string, name: string): Promise<void> => {
    await page.keyboard.press(object);
    await page.keyboard.press('t');
    await page.keyboard.type(name);
    await page.keyboard.press('Enter');
  };
  // A colour that is looked for in the palette is one step.
  const colour = page.getByLabel('Colour of Object 1');
  const first = await colour.inputValue();
  await colour.evaluate((field: HTMLInputElement) => {
    for (const value of ['#101010', '#202020', '#303030']) {
      field.value = value;
      field.dispatchEvent(new Event('input', { bubbles: true }));
    }
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await enter(names.nth(2), 'the cube');
  await classify('1', 'ball');
  await classify('2', 'crate');
  const own = (object: number) => page.locator(`#objects [data-mask="${object}"] .class`);
  await expect(names.nth(1)).toHaveValue('ball 1');
  await expect(names.nth(2)).toHaveValue('the cube');
  await expect(own(2)).toHaveValue('crate');
  await expect(page.locator('#class-names option')).toHaveText(['person', 'box', 'ball', 'crate']);

  // Classes and names are steps of undo.
  const undo = page.locator('#undo');
  await undo.click();
  await expect(own(2)).toHaveValue('');
  await undo.click();
  await expect(names.nth(1)).toHaveValue('Object 1');
  await undo.click();
  await expect(names.nth(2)).toHaveValue('Object 2');
  await expect(colour).toHaveValue('#303030');
  await undo.click();
  await expect(colour).toHaveValue(first);
  await expect(undo).toBeDisabled();
  for (let k = 0; k < 4; k++) await page.locator('#redo').click();
  await expect(names.nth(1)).toHaveValue('ball 1');
  await expect(own(2)).toHaveValue('crate');

  const numbered = ['person', 'box', 'ball', 'crate'].map((name, k) => ({ id: k + 1, name }));
  const coco = await savedClip(page, 'COCO, RLE');
  const { categories: written, annotations } = JSON.parse(coco.bytes.toString()) as { categories: unknown; annotations: { category_id: number }[] };
  expect(written).toEqual(numbered);
  expect(new Set(annotations.map(({ category_id }) => category_id))).toEqual(new Set([3, 4]));
  expect((JSON.parse((await savedClip(page, 'YouTube-VIS')).bytes.toString()) as { categories: unknown }).categories).toEqual(numbered);
  const cvat = (await savedClip(page, 'CVAT, tracks')).bytes.toString();
  expect([...cvat.matchAll(/<label><name>(\w+)/g)].map(([, name]) => name)).toEqual(['person', 'box', 'ball', 'crate']);
  expect([...cvat.matchAll(/<track [^>]*label="([^"]*)"/g)].map(([, label]) => label)).toEqual(['ball', 'crate']);
  const yolo = unzipSync((await savedClip(page, 'YOLO segmentation')).bytes);
  expect([text(yolo['yolo/names.txt']), text(yolo['yolo/labels/f00.txt']).match(/^\d+/gm)]).toEqual(['person\nbox\nball\ncrate\n', ['2', '3']]);
  await page.keyboard.press('Escape');

  // The classes of a file are those of its objects.
  await page.keyboard.press('1');
  await enter(own(1), '');
  await expect(names.nth(1)).toHaveValue('Object 1');
  await give(page, 'drop', [file('coco.json', coco.bytes.toString())]);
  await clipDone(page);
  await expect(names.nth(1)).toHaveValue('ball 1');
  await undo.click();
  await expect(names.nth(1)).toHaveValue('Object 1');
});
