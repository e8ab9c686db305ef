// npm run annotator -- --page: an expert annotates real clips in the page, in headless Chromium, from their frames to a file for CVAT,
// with few actions. J is that of the file. Prints a table. Options are in USAGE.

import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';

import { masksOfCvat } from './lib/annotator/cvat.mjs';
import { annotate } from './lib/annotator/expert.mjs';
import { mean, overlap } from './lib/annotator/overlap.mjs';
import { annotatedPage } from './lib/annotator/page.mjs';
import { buildPage } from './lib/builds.mjs';
import { present } from './lib/documented.mjs';
import { openBrowser } from './lib/launch-chromium.mjs';
import { prepare } from './lib/prepare.mjs';
import { root } from './lib/project.mjs';
import { Stop, command } from './lib/run.mjs';

const USAGE = `npm run annotator -- --page [OPTIONS]: an expert annotates clips in the page, in headless Chromium

  --data DIR       folder of the clips; default ../shared/data/clips
  --only A,B       these clips; default soccerball,car-turn,motorbike
  --actions N      most actions for a clip; default 20
  --write-docs     also write the figures to docs/figures, and docs/annotating.md from them`;
const DATA = { chosenOn: 'motorbike, the rules of the expert', heldOut: 'the other clips, of the rules' };
const VIEW = { width: 1440, height: 900 };

await command(async (args) => {
  const options = parse(args);
  if (options === null) return console.log(USAGE);
  for (const clip of options.only)
    if (!existsSync(join(options.data, clip, 'masks'))) throw new Stop(`${join(options.data, clip)} has no frames and masks.`);
  const { chromium } = await prepare({ browser: true });
  await buildPage();
  const { decodeImage } = await import('../pkg/dist/codecs.js');
  const { browser, address, close } = await openBrowser(chromium, join(root, 'www/dist'));
  const rows = [];
  try {
    for (const clip of options.only) {
      // Without work that is kept of another run.
      const page = await browser.newPage({ viewport: VIEW });
      rows.push({
        clip,
        ...(await annotated(await annotatedPage(page, address, 'quality=best'), join(options.data, clip), options.actions, decodeImage)),
      });
      console.log(JSON.stringify(rows.at(-1)));
      await page.context().close();
    }
    const figures = rows.map(({ log: _, ...figures }) => figures);
    present(
      'annotator-page',
      { command: 'npm run annotator -- --page', data: DATA, chromium: browser.version() },
      { rows: figures },
      options.writeDocs,
    );
  } finally {
    await close();
  }
  return 0;
});

/** The options; `null` for help. */
function parse(args) {
  const [text, flag] = [{ type: 'string' }, { type: 'boolean', default: false }];
  let values;
  try {
    ({ values } = parseArgs({ args, options: { data: text, only: text, actions: text, 'write-docs': flag, page: flag, help: flag } }));
  } catch (error) {
    throw new Stop(error.message);
  }
  if (values.help) return null;
  const { data = '../shared/data/clips', only = 'soccerball,car-turn,motorbike', actions = '20', 'write-docs': writeDocs } = values;
  if (!/^\d+$/.test(actions) || Number(actions) < 5) throw new Stop('--actions must be a whole number from 5.');
  return { data: resolve(root, data), only: only.split(','), actions: Number(actions), writeDocs };
}

/** Has a clip annotated, and reads what was saved. */
async function annotated(page, folder, most, decodeImage) {
  const filesIn = (name) =>
    readdirSync(join(folder, name))
      .sort()
      .map((file) => join(folder, name, file));
  const truths = [];
  let size = null;
  for (const file of filesIn('masks')) {
    const { data, width, height } = await decodeImage(readFileSync(file));
    size = { width, height };
    truths.push(Uint8Array.from({ length: width * height }, (_, p) => Number(data[4 * p] + data[4 * p + 1] + data[4 * p + 2] > 0)));
  }
  const { path, id, found } = await annotate(page, filesIn('frames'), truths, { width: size.width, most });
  const masks = masksOfCvat(readFileSync(path, 'utf8'), { ...size, frames: truths.length }).get(id);
  const nothing = new Uint8Array(size.width * size.height);
  const j = mean(truths.map((truth, index) => overlap(masks?.[index] ?? nothing, truth)));
  return { frames: truths.length, found, actions: page.actions(), seconds: page.seconds(), j, log: page.log };
}
