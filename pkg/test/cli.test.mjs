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

  for (const [option, ...options] of [[''], ['--grouped', '--grouped'], ['--subject', '--subject']]) {
    test(`--out writes files that read back ${option}`, async (t) => {
      const { folder, first, second } = frames(t);
      const out = folder.path('a', 'b');
      const run = await veronese(['pair', first, second, '--out', out, '--overlay', ...options]);
      const found = json(run);
      const direct = await segmentPair(...pair(), { subject: option === '--subject' });
      const labels = option ? groupLabels(direct) : direct.labels;
      const numbers = [...new Set(direct.motions.map(({ label, group }) => (option ? group : label)))];
      assert.deepEqual(entries(out), ['labels.png', ...numbers.map((number) => `mask-${number}.png`), 'overlay.png', 'result.json'].sort());
      assert.equal(readFileSync(`${out}/result.json`, 'utf8'), run.stdout);
      const picture = (name, kind) => {
        const file = readFileSync(`${out}/${name}.png`);
        assert.deepEqual([...file.subarray(24, 26)], [8, kind], '8 bits, and grey, RGB or indexed');
        return decode(file);
      };
      const image = picture('labels', 3);
      assert.deepEqual([image.width, image.height], [64, 48]);
      assert.deepEqual(new Uint8Array(image.data), labels);
      assert.deepEqual(image.palette.map((colour) => [...colour].slice(0, 3)), davisPalette());
      if (!option) checkLabels(new Uint8Array(image.data), found);
      for (const number of numbers) assert.deepEqual(new Uint8Array(picture(`mask-${number}`, 0).data), labels.map((label) => (label === number ? 255 : 0)));
      assert.deepEqual(new Uint8Array(picture('overlay', 2).data), overlay(pair()[0].data, labels));
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
    // A byte order mark does not matter.
    const path = folder.file('points.json', `\ufeff${file(measurements)}`);
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
  test('refuses what is none', async (t) => {
    const folder = temporaryFolder(t);
    for (const [code, content] of Object.values(bad)) checkError(await veronese(['points', folder.file('points.json', content)]), 1, code);
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
  test('what is no frame, or none of that size; nothing is written', async (t) => {
    const { folder, first } = frames(t);
    const out = folder.path('out');
    const refuses = async (code, ...names) => checkError(await veronese(['pair', ...names, '--out', out]), 1, code);
    for (const [code, content] of Object.values(bad)) await refuses(code, first, folder.file('bad', content));
    await refuses('file-not-found', folder.path('none.png'), first);
    await refuses('unreadable-file', first, folder.path('.'));
    if (spawnSync('mkfifo', [folder.path('pipe')]).status === 0) await refuses('unreadable-file', first, folder.path('pipe'));
    await refuses('file-not-found', first, `${first}/second.png`);
    assert.ok(!existsSync(out));
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
  const wrong = [
    ['usage', []],
    ['usage', ['pear', 'a', 'b']],
    ['usage', ['pair', 'a']],
    ['usage', ['points']],
    ['wrong-usage', ['pair', 'a', 'b', '--speed', '3']],
    ['wrong-usage', ['points', 'a', '--quality', 'best']],
    ['usage', ['pair', 'a', 'b', '--out']],
    ['usage', ['pair', 'a', 'b', '--out', '']],
    ['usage', ['pair', '', 'b']],
    ['usage', ['pair', 'a', 'b', '--grouped=yes']],
    ['usage', ['pair', 'a', 'b', '--overlay']],
    ['invalid-option', ['pair', 'a', 'b', '--motions', '0']],
    ['invalid-option', ['points', 'a', '--motions', '11']],
    ['invalid-option', ['pair', 'a', 'b', '--quality', 'good']],
    ['invalid-option', ['points', 'a', '--seed=-1']],
    ['usage', ['clip', 'a']],
    ['invalid-option', ['clip', 'a', '--out', 'b', '--look-ahead', '9']],
    ['usage', ['batch']],
    ['invalid-option', ['batch', 'a', '--jobs', '0']],
    ['invalid-option', ['batch', 'a', '--jobs', '257']],
    ['invalid-option', ['batch', 'a', '--every', '0']],
    ['invalid-option', ['batch', 'a', '--shard', '3/2']],
  ];
  test('that is wrong ends with 2 and one line', async () => {
    for (const [code, args] of wrong) checkError(await veronese(args), 2, code);
  });
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
