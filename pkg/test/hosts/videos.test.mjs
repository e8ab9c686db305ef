// Videos of Label Studio's tasks: boxes that follow the objects, and what the backend does not do for a video.

import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { describe, test } from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import { segmentClip } from 'veronese';
import { boxesOf, rateOf } from '../../../examples/hosts/boxes.mjs';
import { createFollow } from '../../../examples/hosts/video.mjs';
import { png } from '../support/frames.mjs';
import { backend, clip, frames, listen, post, recorded, video, videoTask, withoutVideos } from './asking.mjs';

const film = clip();
const bytes = withoutVideos ? undefined : video(film);

/** A server that has one file, and a backend that may fetch it. */
async function served(t, content, { type = 'video/x-matroska', ...options } = {}) {
  const origin = await listen(t, (_, response) => response.writeHead(200, { 'Content-Type': type }).end(content));
  return { film: `${origin}/film`, predict: `${await backend(t, { allow: [origin], ...options })}/predict` };
}

/** The temporary folders of videos. */
const folders = () => readdirSync(tmpdir()).filter((name) => name.startsWith('veronese-video-'));

/** The box of each object in each frame, in pixels, as `segmentClip` itself finds the objects. */
async function found() {
  const boxes = [];
  for await (const { labels, objects } of segmentClip({ length: film.length, read: (k) => film[k] }, { quality: 'fast' })) {
    boxes.push(Object.fromEntries(objects.map(({ id }) => [id, around(labels, id)])));
  }
  return boxes;
}

function around(labels, id) {
  const at = [...labels.keys()].filter((k) => labels[k] === id);
  const [x, y] = [at.map((k) => k % film[0].width), at.map((k) => Math.floor(k / film[0].width))];
  return [Math.min(...x), Math.min(...y), Math.max(...x) + 1 - Math.min(...x), Math.max(...y) + 1 - Math.min(...y)];
}

/** The same in a result: by Label Studio's rules a box is there from a key frame that is enabled on. */
function shown({ value: { sequence, framesCount } }) {
  return Array.from({ length: framesCount }, (_, k) => {
    const last = sequence.filter(({ frame }) => frame <= k + 1).at(-1);
    if (!last || (last.frame !== k + 1 && !last.enabled)) return undefined;
    assert.equal(last.frame, k + 1, 'every frame is a key frame: nothing is interpolated');
    const { width, height } = film[0];
    return [last.x * width, last.y * height, last.width * width, last.height * height].map((share) => Math.round(share) / 100);
  });
}

describe('a video', { skip: withoutVideos, timeout: 120_000 }, () => {
  test('gets the boxes of the objects that segmentClip finds, in percent, frames from 1', async (t) => {
    const { film: address, predict } = await served(t, bytes);
    const { status, body } = await post(predict, videoTask(address));
    assert.equal(status, 200, JSON.stringify(body));
    const [{ result, score, model_version: version }] = body.results;
    const boxes = await found();
    const objects = [...new Set(boxes.flatMap((frame) => Object.keys(frame)))];
    assert.ok(objects.length > 0 && boxes.length === film.length, 'something moves');
    assert.deepEqual(result.map(shown), objects.map((id) => boxes.map((frame) => frame[id])));
    for (const [index, { type, from_name: from, to_name: to, value }] of result.entries()) {
      assert.deepEqual([type, from, to, value.framesCount, value.duration], ['videorectangle', 'box', 'film', 8, 0.8]);
      assert.deepEqual(value.labels, [index === 0 ? 'car' : 'other']);
      assert.ok(value.sequence.every(({ frame, time }) => Math.abs(time - (frame - 1) / 10) < 1e-9));
    }
    assert.ok(score > 0 && score <= 1, String(score));
    assert.match(version, /^veronese-/);
    assert.deepEqual(folders(), []);
  });

  test('is fetched from Label Studio as its own request says', async (t) => {
    const asked = [];
    const origin = await listen(t, ({ url, headers }, response) => {
      asked.push([url, headers.authorization]);
      response.writeHead(200, { 'Content-Type': 'video/mp4' }).end(bytes);
    });
    const { setup, predict } = recorded(origin).videos;
    const address = await backend(t, { studio: origin });
    assert.equal((await post(`${address}/setup`, setup)).status, 200);
    const { status, body } = await post(`${address}/predict`, predict);
    assert.equal(status, 200, JSON.stringify(body));
    const [{ from_name: from, to_name: to, value }] = body.results[0].result;
    assert.deepEqual([from, to, value.labels, value.framesCount], ['box', 'video', ['moving'], film.length]);
    assert.deepEqual(asked, [[predict.tasks[0].data.video, 'Token secret']]);
  });

  test('is counted as Label Studio counts, whatever the rate of the file', async () => {
    const boxes = await found();
    const [id] = Object.keys(boxes[0]);
    const names = { fromName: 'box', toName: 'film', labels: ['car'], modelVersion: 'x' };
    await createFollow()(bytes, async (clip) => {
      for (const [rate, shownAt] of [
        [20, Array.from({ length: 16 }, (_, k) => Math.floor(k / 2))],
        [5, [0, 2, 4, 6]],
        [30, Array.from({ length: 24 }, (_, k) => Math.floor(k / 3))],
        [1, [0]],
      ]) {
        const { result } = await boxesOf(clip, rate, names);
        assert.deepEqual(shown(result[0]), shownAt.map((k) => boxes[k][id]), String(rate));
      }
      await assert.rejects(boxesOf(clip, 1e9, names), { status: 422, code: 'invalid-input' });
    });
  });

  test('can be in the task itself, of any container and without a type', async (t) => {
    const data = `data:video/mp4;base64,${video(film, { format: 'avi' }).toString('base64')}`;
    const { status, body } = await post(`${await backend(t)}/predict`, videoTask(data));
    assert.equal(status, 200, JSON.stringify(body));
    assert.ok(body.results[0].result.length > 0);
  });
});

describe('a video is refused', { skip: withoutVideos, timeout: 120_000 }, () => {
  async function refused(t, content, options, expected) {
    const { film: address, predict } = await served(t, content, options);
    const { status, body } = await post(predict, videoTask(address));
    assert.deepEqual([status, body.error?.code], expected, JSON.stringify(body));
    assert.doesNotMatch(body.error.message, /veronese-video-/, 'folders of this computer are nobody\'s business');
    assert.deepEqual(folders(), []);
    return body.error.message;
  }

  test('that has too many frames, or too large ones, before any is decoded', async (t) => {
    assert.match(await refused(t, bytes, { frames: 7 }, [422, 'too-many-frames']), /8 frames/);
    await refused(t, bytes, { pixels: 96 * 72 - 1 }, [422, 'frame-size-unsupported']);
    const { film: address, predict } = await served(t, bytes, { frames: 8, pixels: 96 * 72 });
    assert.equal((await post(predict, videoTask(address))).status, 200);
  });

  test('that takes too long', async (t) => {
    assert.match(await refused(t, bytes, { seconds: 0.05 }, [422, 'too-slow']), /veronese clip/);
  });

  test('that is none', async (t) => {
    for (const [content, code] of [
      ['no film', 'unreadable-video'],
      ['', 'unreadable-video'],
      [png(frames[0]), 'unreadable-video'],
      // Half of it: whatever was found in the frames before, the file is not what it was.
      [bytes.subarray(0, 200), 'unreadable-video'],
      [video(film.slice(0, 1)), 'too-few-frames'],
    ]) await refused(t, content, {}, [422, code]);
  });

  test('that only names other files', async (t) => {
    const asked = [];
    const other = await listen(t, (incoming, response) => {
      asked.push(incoming.url);
      response.end(bytes);
    });
    for (const text of [
      `#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n${other}/1.ts\n#EXT-X-ENDLIST\n`,
      `#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nfile:///etc/hostname\n#EXT-X-ENDLIST\n`,
      `ffconcat version 1.0\nfile '${other}/1.mkv'\n`,
      `v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 5004 RTP/AVP 96\na=rtpmap:96 H264/90000\n`,
      `<?xml version="1.0"?><MPD xmlns="urn:mpeg:dash:schema:mpd:2011" type="static"><BaseURL>${other}/</BaseURL></MPD>`,
    ]) await refused(t, text, {}, [422, 'unreadable-video']);
    assert.deepEqual(asked, []);
  });

  test('programs that read it do not see the token', { skip: !existsSync('/proc/self/environ') && 'this system does not show what programs are given' }, async (t) => {
    process.env.LABEL_STUDIO_API_KEY = 'secret';
    t.after(() => delete process.env.LABEL_STUDIO_API_KEY);
    const { film: address, predict } = await served(t, video(clip(60, { width: 320, height: 240 })));
    const stop = new AbortController();
    const asked = fetch(predict, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(videoTask(address)), signal: stop.signal });
    let seen;
    while (!seen) {
      await sleep(20);
      for (const id of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
        try {
          if (!readFileSync(`/proc/${id}/cmdline`, 'utf8').includes('veronese-video-')) continue;
          seen = readFileSync(`/proc/${id}/environ`, 'utf8') || undefined;
        } catch {
          // It has ended.
        }
      }
    }
    stop.abort();
    await assert.rejects(asked, { name: 'AbortError' });
    assert.ok(seen.includes('PATH='));
    assert.ok(!seen.includes('secret'));
  });
});

test('the rate is what Label Studio makes of it', () => {
  for (const [text, data, rate] of [
    [undefined, {}, 24], ['25', {}, 25], ['29.97', {}, 29.97], ['0.04', {}, 25], ['0', {}, 24], ['fast', {}, 24], ['-3', {}, 24], ['Infinity', {}, 24],
    ['$fps', { fps: 12 }, 12], ['$fps', { fps: '50' }, 50], ['$fps', {}, 24], ['$fps', undefined, 24], ['$fps', { fps: {} }, 24],
  ]) assert.equal(rateOf(text, data), rate, `${text} ${JSON.stringify(data)}`);
});
