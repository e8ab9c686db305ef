// npm run bench -- NAME: measures one thing. --write-docs, where it is offered, writes the figures to docs/figures and into the pages.
//   native     the public calls, by criterion; further arguments go to it. Without a name, this
//   masks      masks of generated scenes and real pairs, beside OpenCV
//   clips      labels that last through clips, beside OpenCV
//   browser    times in Chromium, beside OpenCV.js and native code
//   page       the page: a first visit, a long video, corrections
//   scaling    the cost of a frame of a clip

import { checkRust } from './lib/rust.mjs';
import { Stop, command, run } from './lib/run.mjs';

const NAMES = ['native', 'masks', 'clips', 'browser', 'page', 'scaling'];
const [name = 'native', ...rest] = process.argv.slice(2);

if (NAMES.slice(1).includes(name)) {
  process.argv.splice(2, 1);
  await import(`./bench/${name}.mjs`);
} else {
  await command(async () => {
    if (name !== 'native') throw new Stop(`There is no benchmark '${name}'; there are ${NAMES.join(', ')}.`);
    await checkRust();
    return (await run('cargo', ['bench', '--locked', '--package', 'benches', '--benches', '--', ...rest])).code;
  });
}
