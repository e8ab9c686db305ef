// npm run guide:pictures: draws the pictures of the guide, site/pages/guide/images, from what the package finds in the bundled frames. Those
// of Label Studio are cut from the screenshots of `npm run proof:label-studio`, and stay as they are without them.

import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { prepareChromium } from './lib/chromium.mjs';
import { inProject, root } from './lib/project.mjs';
import { Stop, command, must } from './lib/run.mjs';

const OUT = join(root, 'site/pages/guide/images');
const SAMPLES = join(root, 'www/public/samples');
const PROGRAM = join(root, 'pkg/bin/veronese.js');
const PROOF = join(root, 'out/proof/label-studio');
/** The frames of which the guide speaks, and the one that is shown. */
const [FIRST, LAST, SHOWN] = [20, 31, 26];
const LARGEST = 80 * 1024;

await command(async () => {
  if (!inProject('pkg/dist/node.js')) throw new Stop('The package is not built: run `npm run build` first.');
  const folder = mkdtempSync(join(tmpdir(), 'veronese-pictures-'));
  try {
    mkdirSync(OUT, { recursive: true });
    await draw(folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
  for (const name of readdirSync(OUT)) {
    const { size } = statSync(join(OUT, name));
    if (size > LARGEST) throw new Stop(`${name} has ${size} bytes, more than ${LARGEST}.`);
    console.log(`${name}: ${size} bytes`);
  }
});

async function draw(folder) {
  const at = (...names) => join(folder, ...names);
  const frames = Array.from({ length: LAST - FIRST + 1 }, (_, k) => join(SAMPLES, `passing-cars/frames/${FIRST + k}.webp`));
  const clip = (out, ...options) => veronese('clip', ...frames, '--out', at(out), '--quality', 'fast', '--overlay', ...options);
  await clip('found');
  await webp('start', [at('found/overlay', `${SHOWN}.png`)]);

  const pair = ['first', 'second'].map((name) => join(SAMPLES, `intel-two-cars/${name}.png`));
  await veronese('pair', ...pair, '--grouped', '--overlay', '--out', at('pair'));
  await webp('pairs', [pair[0], at('pair/overlay.png')], 'hstack,scale=1000:-2');

  await say(at('said'));
  await clip('corrected', '--corrections', at('said'));
  await webp('corrections', ['found', 'corrected'].map((name) => at(name, 'overlay', `${SHOWN}.png`)), 'hstack');

  await veronese('convert', at('found'), '--to', 'cvat-video');
  await outlines(at('found/cvat-video.xml'), at('cvat.png'));
  await webp('cvat-tracks', [at('cvat.png')]);

  await webp('label-studio-masks', [join(PROOF, 'task.png')], 'crop=1042:330:238:100');
  await webp('label-studio-boxes', [join(PROOF, 'video.png')], 'crop=1042:530:238:305,scale=800:-2');
}

/** What the page about corrections says, by its own code. */
async function say(folder) {
  const { encodeGreyPng } = await import('../pkg/dist/codecs.js');
  mkdirSync(folder);
  for (const [name, left, top, right, bottom] of [['20', 80, 122, 165, 145], ['31', 60, 245, 170, 262]]) {
    const said = new Uint8Array(512 * 288).fill(255);
    for (let y = top; y < bottom; y++) said.fill(0, y * 512 + left, y * 512 + right);
    writeFileSync(join(folder, `${name}.png`), await encodeGreyPng(512, 288, said));
  }
}

/** The polygons of a CVAT file over their frame, drawn by a browser from the file itself. */
async function outlines(file, picture) {
  const { chromium } = await import('@playwright/test');
  const { path, problem } = await prepareChromium();
  if (problem) throw new Stop(problem);
  const xml = readFileSync(file, 'utf8');
  const polygons = [...xml.matchAll(new RegExp(`<polygon frame="${SHOWN - FIRST}"[^>]* outside="0"[^>]* points="([^"]*)"`, 'g'))].map(([, points]) => points.replaceAll(';', ' '));
  if (polygons.length === 0) throw new Stop(`${file} has no polygon of frame ${SHOWN - FIRST}.`);
  const frame = readFileSync(join(SAMPLES, `passing-cars/frames/${SHOWN}.webp`)).toString('base64');
  const dots = (points, colour) => points.split(' ').map((point) => `<circle cx="${point.split(',')[0]}" cy="${point.split(',')[1]}" r="1.6" fill="${colour}"/>`);
  const shapes = polygons.flatMap((points, k) => {
    const colour = ['#33ddff', '#ffcc33'][k % 2];
    return [`<polygon points="${points}" fill="${colour}" fill-opacity=".3" stroke="${colour}" stroke-width="1"/>`, ...dots(points, colour)];
  });
  const browser = await chromium.launch({ executablePath: path, args: ['--no-sandbox'] });
  const page = await browser.newPage({ viewport: { width: 768, height: 432 } });
  await page.setContent(
    `<body style="margin:0"><svg width="768" height="432" viewBox="0 0 512 288"><image width="512" height="288" href="data:image/webp;base64,${frame}"/>${shapes.join('')}</svg>`,
  );
  await page.screenshot({ path: picture });
  await browser.close();
}

function veronese(...args) {
  return must(`veronese ${args[0]} failed.`, process.execPath, [PROGRAM, ...args], { output: 'collect' });
}

/** One WebP of some pictures; nothing if they are not there. */
async function webp(name, pictures, filter) {
  if (!pictures.every(existsSync)) return;
  const inputs = pictures.flatMap((path) => ['-i', path]);
  const filters = filter ? ['-filter_complex', filter] : [];
  const sentence = 'A picture could not be made: that takes the program ffmpeg with WebP.';
  await must(sentence, 'ffmpeg', ['-v', 'error', '-y', ...inputs, ...filters, '-frames:v', '1', '-c:v', 'libwebp', '-quality', '80', join(OUT, `${name}.webp`)]);
}
