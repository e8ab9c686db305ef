// What the encoders write, read by the decoders of the tools it is meant for.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, describe, test } from 'node:test';
import * as formats from 'veronese/formats';
import { labelImages, present } from '../support/masks.mjs';
import { decoded, skip } from '../support/python.mjs';

const base64 = (bytes) => Buffer.from(bytes).toString('base64');

function encoded(labels, width, height) {
  const all = [labels, width, height, {}];
  // The second frame turned half round with other labels, so that frames cannot be taken for each other.
  const second = labels.toReversed().map((label) => (label === 255 ? 127 : label >> 1));
  return {
    cocoRle: formats.encodeCoco(...all),
    cocoPolygon: formats.encodeCoco(...all, { shape: 'polygon' }),
    cocoCounts: Object.fromEntries(
      present(labels).map((label) => [label, formats.encodeCocoRleCounts(labels.map((value) => Number(value === label)), width, height)]),
    ),
    cocoVideo: formats.encodeCocoVideo([{ labels, width, height }, { labels: second, width, height }]),
    cvatXmlMask: formats.encodeCvatXml(...all),
    cvatXmlPolygon: formats.encodeCvatXml(...all, { shape: 'polygon' }),
    cvatPoints: formats.encodeCvatPoints(...all),
    cvatMots: base64(formats.encodeCvatMots([{ labels, width, height }, { labels: second, width, height }])),
    labelStudioBrush: formats.encodeLabelStudio(...all),
    labelStudioPolygon: formats.encodeLabelStudio(...all, { shape: 'polygon' }),
    labelMe: formats.encodeLabelMe(...all),
    yolo: formats.encodeYolo(...all),
    davis: base64(formats.encodeDavis(labels, width, height)),
    supervisely: formats.encodeSupervisely(...all),
  };
}

describe('decoded by the tools themselves, the same pixels', { skip }, () => {
  const folder = mkdtempSync(join(tmpdir(), 'veronese-formats-'));
  after(() => rmSync(folder, { recursive: true, force: true }));
  const images = labelImages(220);
  let report = {};

  test('the decoders run', () => {
    const cases = images.map(({ labels, width, height }) => ({ labels: base64(labels), width, height, encoded: encoded(labels, width, height) }));
    writeFileSync(join(folder, 'cases.json'), JSON.stringify(cases));
    report = decoded('decode.py', folder);
  });

  for (const name of Object.keys(encoded(new Uint8Array(1), 1, 1))) {
    test(name, () => {
      assert.deepEqual(report[name]?.mistakes, []);
      assert.equal(report[name].images, images.length);
      assert.ok(report[name].masks >= 200, `${report[name].masks} masks`);
    });
  }
});
