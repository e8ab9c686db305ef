// Labelling configurations, as the Label Studio backend reads them.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readConfig } from '../../../examples/hosts/label-config.mjs';
import { CONFIG, VIDEO_CONFIG } from './asking.mjs';

const simple = { fromName: 'b', toName: 'a', labels: ['x'], keys: ['one', 'two'] };
const around = (inside) => `<View>${inside}<Image name="a" value="$one"/><Image name="z" value="$two"/></View>`;

test('configurations are read however they are written', () => {
  assert.deepEqual(readConfig(CONFIG), { fromName: 'moving', toName: 'before', labels: ['car & shadow', 'second'], keys: ['first', 'second'] });
  for (const config of [
    around('<BrushLabels name="b" toName="a"><Label value="x"/></BrushLabels>'),
    around("<BrushLabels toName = 'a'\n name='b' ><View><Label value='x'></Label></View></BrushLabels>"),
    `<?xml version="1.0" encoding="UTF-8"?>\n<!-- > -->${around('<BrushLabels name="b" toName="a" hint="a > b"><Label value="x"/></BrushLabels>')}`,
    around('<!-- <BrushLabels name="no" toName="z"/> --><BrushLabels name="b" toName="a"><!-- <Label value="no"/> --><Label value="x"/></BrushLabels>'),
    around('<Choices name="c" toName="a"><Label value="no"/></Choices><BrushLabels name="b" toName="a"><Label value="&#120;"/></BrushLabels>'),
  ]) assert.deepEqual(readConfig(config), simple, config);
});

test('a configuration with boxes on a video', () => {
  const found = { fromName: 'box', toName: 'film', labels: ['car', 'other'], video: 'video', frameRate: '$fps' };
  assert.deepEqual(readConfig(VIDEO_CONFIG), found);
  const { frameRate, ...plain } = found;
  assert.deepEqual(readConfig(VIDEO_CONFIG.replace('frameRate', 'framerate')), { ...plain, frameRate });
  assert.deepEqual(readConfig(VIDEO_CONFIG.replace('frameRate="$fps"', '')), plain);
  const more = '<Labels name="n" toName="text"><Label value="no"/></Labels><Text name="text" value="$text"/><Video name="second" value="$no"/>';
  assert.deepEqual(readConfig(VIDEO_CONFIG.replace('<View>', `<View>${more}`)), found);
});

test('configurations that are none are refused with a sentence', () => {
  for (const config of [
    undefined, null, 7, {}, '', 'text', '<View', '<View>', '<View></Viewer>', around('<BrushLabels name="b" toName="a">'),
    around('<BrushLabels toName="a"/>'), around('<BrushLabels name="b"/>'), around('<BrushLabels name="b" toName="nowhere"/>'),
    around('<BrushLabels name="b" toName="a"><Label/></BrushLabels>'), around('<BrushLabels name="b" name="c" toName="a"/>'),
    '<View><BrushLabels name="b" toName="a"/><Image name="a"/><Image name="z" value="$two"/></View>',
    `<!DOCTYPE View [<!ENTITY e "eeee">]>${around('<BrushLabels name="b" toName="a"><Label value="&e;"/></BrushLabels>')}`,
    around(`<BrushLabels name="b" toName="a"><Label value="${'x'.repeat(70_000)}"/></BrushLabels>`),
    VIDEO_CONFIG.replace('toName="film"/>', 'toName="other"/>'), VIDEO_CONFIG.replace('<Video ', '<Image '), VIDEO_CONFIG.replace(/<Labels.*Labels>/, ''),
    VIDEO_CONFIG.replace('value="$video"', ''), VIDEO_CONFIG.replace('value="car"', ''), VIDEO_CONFIG.replace('name="box"', ''),
    '<View><Video name="v" value="$v"/><BrushLabels name="b" toName="v"><Label value="x"/></BrushLabels></View>',
  ]) assert.throws(() => readConfig(config), { status: 422, code: 'invalid-input' }, String(config).slice(0, 100));
});
