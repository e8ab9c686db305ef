import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, openSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, test } from 'node:test';
import { decode } from 'fast-png';
import { davisPalette, fitMotions, groupLabels, segmentPair } from 'veronese';
import { Output } from '../build/cli/output.js';
import { overlay } from '../build/cli/overlay.js';
import { bmp, frame, pair, png, points, ppm, ramp } from './support/frames.mjs';
import { entries, temporaryFolder, veronese, veroneseProcess } from './support/program.mjs';
import { signalledAt } from './support/stopping.mjs';
import { checkLabels, checkPair, timeless } from './support/shapes.mjs';

/** A folder with two frames as files. */
function frames(t, options) {
  const folder = temporaryFolder(t);
  const [first, second] = pair(options);
  return { folder, first: folder.file('first.png', png(first)), second: folder.file('second.png', png(second)) };
}

function json({ code, stdout, stderr }) {
  assert.equal(stderr, '');
  assert.equal(code, 0);
  assert.match(stdout, /^\{.*\}\n$/, 'one line');
  return JSON.parse(stdout);
}

function checkError({ code, stdout, stderr, seconds }, exit, errorCode) {
  assert.match(stderr, /^veronese: error: [a-z]+(-[a-z]+)*: \S.*\n$/);
  assert.equal(stderr.split(': ')[2], errorCode, stderr);
  assert.equal(stdout, '');
  assert.equal(code, exit);
  assert.ok(seconds < 5, `took ${seconds} s`);
}

const withoutLabels = ({ labels, ...rest }) => rest;

describe('veronese pair', () => {
  test('prints what segmentPair gives, with every option handed on', async (t) => {
    const { first, second } = frames(t);
    const options = { motions: 2, quality: 'fast', markUnknown: true, subject: true };
    for (const [args, given] of [[['--motions=auto'], {}], [['--motions', '2', '--quality', 'fast', '--mark-unknown', '--subject'], options]]) {
      const found = json(await veronese(['pair', ...args, first, second]));
      checkPair(found, 64, 48);
      assert.deepEqual(timeless(found), timeless(withoutLabels(await segmentPair(...pair(), given))));
    }
  });

  for (const option of [undefined, '--grouped', '--subject']) {
    const grouped = option !== undefined;
    test(`--out writes files that read back${grouped ? `, ${option} by groups` : ''}`, async (t) => {
      const { folder, first, second } = frames(t);
      const out = folder.path('a', 'b');
      const args = ['pair', first, second, '--out', out, '--overlay', ...(option ? [option] : [])];
      const run = await veronese(args);
      const found = json(run);
      const direct = await segmentPair(...pair(), { subject: option === '--subject' });
      const labels = grouped ? groupLabels(direct) : direct.labels;
      const numbers = [...new Set(direct.motions.map(({ label, group }) => (grouped ? group : label)))];
      const masks = numbers.map((number) => `mask-${number}.png`);
      assert.deepEqual(entries(out), ['labels.png', ...masks, 'overlay.png', 'result.json'].sort());

      assert.equal(readFileSync(`${out}/result.json`, 'utf8'), run.stdout);
      const file = readFileSync(`${out}/labels.png`);
      assert.deepEqual([file[24], file[25]], [8, 3], '8 bits, indexed');
      const image = decode(file);
      assert.deepEqual([image.width, image.height, image.channels], [64, 48, 1]);
      assert.deepEqual(new Uint8Array(image.data), labels);
      assert.deepEqual(image.palette.map((colour) => [...colour].slice(0, 3)), davisPalette());
      if (!grouped) checkLabels(new Uint8Array(image.data), found);

      for (const number of numbers) {
        const bytes = readFileSync(`${out}/mask-${number}.png`);
        assert.deepEqual([bytes[24], bytes[25]], [8, 0], '8 bits, grey');
        assert.deepEqual(new Uint8Array(decode(bytes).data), labels.map((label) => (label === number ? 255 : 0)));
      }
      const colours = decode(readFileSync(`${out}/overlay.png`));
      assert.deepEqual([colours.width, colours.height, colours.channels], [64, 48, 3]);
      assert.deepEqual(new Uint8Array(colours.data), overlay(pair()[0].data, labels));
    });
  }

  test("--confidence writes how sure the labels are, and changes nothing else; an earlier run's files do not stay", async (t) => {
    const { folder, first, second } = frames(t);
    const out = folder.path('out');
    const found = json(await veronese(['pair', first, second, '--out', out, '--overlay', '--confidence']));
    const { labels, confidence, ...report } = await segmentPair(...pair(), { confidence: true });
    assert.deepEqual(timeless(found), timeless(report));
    const bytes = readFileSync(`${out}/confidence.png`);
    assert.deepEqual([bytes[24], bytes[25]], [8, 0], '8 bits, grey');
    assert.deepEqual(new Uint8Array(decode(bytes).data), confidence);
    json(await veronese(['pair', first, second, '--out', out, '--motions', '1']));
    assert.deepEqual(entries(out), ['labels.png', 'mask-0.png', 'result.json']);
  });

  test('reads PNG, BMP, PNM, WebP and JPEG', async (t) => {
    const folder = temporaryFolder(t);
    const [first, second] = pair();
    const expected = timeless(withoutLabels(await segmentPair(first, second)));
    for (const [encode, name] of [[png, 'png'], [bmp, 'bmp'], [ppm, 'ppm']]) {
      const files = [folder.file(`1.${name}`, encode(first)), folder.file(`2.${name}`, encode(second))];
      assert.deepEqual(timeless(json(await veronese(['pair', ...files]))), expected, name);
    }
    for (const name of ['webp', 'jpeg']) {
      // by content, whatever the file is called
      const file = folder.file(`${name}.dat`, ramp[name]);
      const { code, stdout, stderr } = await veronese(['pair', file, file]);
      assert.equal(code, 0, stderr);
      assert.match(stderr, /^veronese: note: nothing moves between the frames: [^\n]+\n$/);
      checkPair(JSON.parse(stdout), 24, 20);
    }
  });

  for (const [signal, exit] of [['SIGINT', 130], ['SIGTERM', 143]]) {
    test(`${signal} during the work ends it at once with ${exit}, nothing half-written`, { skip: process.platform === 'win32' }, async (t) => {
      const { folder, first, second } = frames(t);
      // The work would never end.
      const options = signalledAt(folder, signal, { call: 'readFile', path: /second\.png$/, stays: true });
      const run = await veroneseProcess(['pair', first, second, '--out', folder.path('out'), '--overlay'], options);
      assert.equal(run.code, exit);
      assert.equal(run.stdout, '');
      assert.match(run.stderr, /^veronese: error: cancelled: [^\n]+\n$/);
      assert.ok(!existsSync(folder.path('out')));
    });
  }
});

describe('veronese points', () => {
  const rows = (array, n) => Array.from({ length: array.length / n }, (_, j) => Array.from(array.subarray(n * j, n * (j + 1))));
  const file = ({ positions, derivatives }) => JSON.stringify({ positions: rows(positions, 2), derivatives: rows(derivatives, 3), note: 'ignored' });

  test('prints what fitMotions gives, with labels as a list', async (t) => {
    const folder = temporaryFolder(t);
    const measurements = points(80, 1.25, -0.5);
    const path = folder.file('points.json', file(measurements));
    for (const [args, options] of [
      [[], {}],
      [['--method', 'paper', '--motions', '1'], { method: 'paper', motions: 1 }],
      [['--method=best', '--motions=2', '--seed=9'], { method: 'best', motions: 2, seed: 9 }],
    ]) {
      const found = json(await veronese(['points', path, ...args]));
      assert.ok(Array.isArray(found.labels));
      const direct = await fitMotions(measurements, options);
      // Through JSON, where −0 is 0.
      assert.deepEqual(timeless(found), timeless(JSON.parse(JSON.stringify({ ...direct, labels: [...direct.labels] }))));
    }
  });

  test('a byte order mark does not matter', async (t) => {
    const path = temporaryFolder(t).file('points.json', `\ufeff${file(points(60, 1, 1))}`);
    json(await veronese(['points', path, '--motions', '1']));
  });

  const P = '[[1, 2], [3, 4]]';
  const D = '[[1, 2, 3], [4, 5, 6]]';
  const bad = {
    'no JSON': ['invalid-json', 'hello'],
    'an empty file': ['invalid-json', ''],
    'NaN': ['invalid-json', `{"positions": [[NaN, 2]], "derivatives": ${D}}`],
    'a number too large for a number': ['not-finite', `{"positions": [[1e999, 2], [3, 4]], "derivatives": ${D}}`],
    'a list': ['invalid-input', '[]'],
    'no derivatives': ['invalid-input', `{"positions": ${P}}`],
    'a null in a row': ['invalid-input', `{"positions": [[1, null], [3, 4]], "derivatives": ${D}}`],
    'a short row': ['invalid-input', `{"positions": [[1, 2], [3]], "derivatives": ${D}}`],
    'flat numbers': ['invalid-input', `{"positions": [1, 2, 3, 4], "derivatives": ${D}}`],
    'lists of different length': ['measurement-count-mismatch', `{"positions": [[1, 2]], "derivatives": ${D}}`],
  };
  for (const [title, [code, content]] of Object.entries(bad)) {
    test(`refuses ${title}`, async (t) => {
      const path = temporaryFolder(t).file('points.json', content);
      checkError(await veronese(['points', path]), 1, code);
    });
  }

  test('refuses a missing file and a folder', async (t) => {
    const folder = temporaryFolder(t);
    checkError(await veronese(['points', folder.path('none.json')]), 1, 'file-not-found');
    checkError(await veronese(['points', folder.path('.')]), 1, 'unreadable-file');
  });
});

describe('veronese pair refuses', () => {
  const whole = png(frame(0));
  const header = (width, height) => {
    const file = Buffer.from(whole);
    file.writeUInt32BE(width, 16);
    file.writeUInt32BE(height, 20);
    return file;
  };
  const bad = {
    'an empty file': ['unreadable-image', ''],
    'a text': ['unreadable-image', 'hello'],
    'a truncated PNG': ['unreadable-image', whole.subarray(0, whole.length / 2)],
    'a PNG header with a wrong checksum': ['unreadable-image', header(70, 48)],
    'a PNM header of enormous sides': ['frame-size-unsupported', 'P6 900000 900000 255\n'],
    'an image of 1×1': ['frame-size-unsupported', ppm({ data: new Uint8Array(4), width: 1, height: 1 })],
    'another size': ['frame-size-mismatch', png(frame(0, { width: 65 }))],
    'a GIF': ['unreadable-image', Buffer.from('R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7', 'base64')],
  };
  for (const [title, [code, content]] of Object.entries(bad)) {
    test(title, async (t) => {
      const { folder, first } = frames(t);
      const out = folder.path('out');
      checkError(await veronese(['pair', first, folder.file('bad', content), '--out', out]), 1, code);
      assert.ok(!existsSync(out), 'nothing is written');
    });
  }

  test('a missing file, a folder, a file below a file', async (t) => {
    const { folder, first } = frames(t);
    checkError(await veronese(['pair', folder.path('none.png'), first]), 1, 'file-not-found');
    checkError(await veronese(['pair', first, folder.path('.')]), 1, 'unreadable-file');
    if (spawnSync('mkfifo', [folder.path('pipe')]).status === 0) {
      checkError(await veronese(['pair', first, folder.path('pipe')]), 1, 'unreadable-file');
    }
    checkError(await veronese(['pair', first, `${first}/second.png`]), 1, 'file-not-found');
  });

  test('an output folder that cannot be one', async (t) => {
    const { folder, first, second } = frames(t);
    const taken = folder.file('taken', '');
    for (const out of [taken, `${taken}/below`]) checkError(await veronese(['pair', first, second, '--out', out]), 1, 'write-failed');
    mkdirSync(folder.path('out', 'labels.png'), { recursive: true });
    checkError(await veronese(['pair', first, second, '--out', folder.path('out'), '--force']), 1, 'write-failed');
    assert.deepEqual(entries(folder.path('out')), ['labels.png'], 'nothing half-written stays');
  });

  test('a full disk behind stdout', { skip: !existsSync('/dev/full') }, async (t) => {
    const { first, second } = frames(t);
    const { code, stderr } = await veroneseProcess(['pair', first, second], { stdout: openSync('/dev/full', 'w') });
    assert.equal(code, 1);
    assert.match(stderr, /^veronese: error: write-failed: [^\n]+\n$/);
  });
});

describe('usage', () => {
  const wrong = {
    'no command': ['usage', []],
    'an unknown command': ['usage', ['pear', 'a', 'b']],
    'one frame': ['usage', ['pair', 'a']],
    'no points': ['usage', ['points']],
    'an unknown option': ['wrong-usage', ['pair', 'a', 'b', '--speed', '3']],
    'an option of the other command': ['wrong-usage', ['points', 'a', '--quality', 'best']],
    'a frame before': ['wrong-usage', ['pair', 'a', 'b', '--before', 'c']],
    'an option without its value': ['usage', ['pair', 'a', 'b', '--out']],
    'an empty value': ['usage', ['pair', 'a', 'b', '--out', '']],
    'an empty name': ['usage', ['pair', '', 'b']],
    'a value for a flag': ['usage', ['pair', 'a', 'b', '--grouped=yes']],
    '--overlay without --out': ['usage', ['pair', 'a', 'b', '--overlay']],
    '--confidence without --out': ['usage', ['pair', 'a', 'b', '--confidence']],
    'no motions': ['invalid-option', ['pair', 'a', 'b', '--motions', '0']],
    'eleven motions': ['invalid-option', ['points', 'a', '--motions', '11']],
    'another quality': ['invalid-option', ['pair', 'a', 'b', '--quality', 'good']],
    'a negative seed': ['invalid-option', ['points', 'a', '--seed=-1']],
    'a clip without --out': ['usage', ['clip', 'a']],
    'an option of pairs for a clip': ['wrong-usage', ['clip', 'a', '--out', 'b', '--grouped']],
    'a look-ahead above 8': ['invalid-option', ['clip', 'a', '--out', 'b', '--look-ahead', '9']],
    'a seed too large': ['invalid-option', ['points', 'a', '--seed', '9007199254740992']],
    'a batch of nothing': ['usage', ['batch']],
    'an empty name in a batch': ['usage', ['batch', 'a', '']],
    'an overlay of a batch without --out': ['usage', ['batch', 'a', '--overlay']],
    'jobs of pair': ['wrong-usage', ['pair', 'a', 'b', '--jobs', '2']],
    'no jobs': ['invalid-option', ['batch', 'a', '--jobs', '0']],
    'too many jobs': ['invalid-option', ['batch', 'a', '--jobs', '257']],
    'every none': ['invalid-option', ['batch', 'a', '--every', '0']],
    'shard 3 of 2': ['invalid-option', ['batch', 'a', '--shard', '3/2']],
  };
  for (const [title, [code, args]] of Object.entries(wrong)) {
    test(`${title} is wrong`, async () => checkError(await veronese(args), 2, code));
  }
});

describe('Output', () => {
  const text = (name) => ({ name, bytes: Buffer.from(name) });
  const made = (t) => {
    const folder = temporaryFolder(t).path('.');
    return { folder, output: new Output(folder, { force: false }) };
  };

  test('a failure in the middle leaves the files of before, whole', async (t) => {
    const { folder, output } = made(t);
    const broken = { name: 'result.json', bytes: Symbol('cannot be written') };
    await output.writeAll([{ name: 'labels.png', bytes: Buffer.from('old') }]);
    await assert.rejects(output.writeAll([text('labels.png'), broken]), { code: 'write-failed' });
    assert.deepEqual(entries(folder), ['labels.png']);
    assert.equal(readFileSync(join(folder, 'labels.png'), 'utf8'), 'old');
  });

  test('discard in the middle removes what is half-written', async (t) => {
    const { folder, output } = made(t);
    const writing = output.writeAll([text('a'), text('b'), text('c')]);
    while (readdirSync(folder).length === 0) await new Promise((resolve) => setImmediate(resolve));
    output.discard();
    await writing.catch(() => {});
    const left = entries(folder);
    assert.ok(left.every((name) => 'abc'.includes(name)), left.join());
  });
});
