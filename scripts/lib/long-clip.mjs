// A generated video of any length for the benchmark of the page: two textured discs go round in front of a textured background.

import { writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

import { root } from './project.mjs';

/** Frames until everything is where it was. They are encoded once, and repeated. */
const ROUND = 60;
const FRAMES_PER_SECOND = 30;

/** Writes a WebM video of that many frames, encoded (VP8) by the browser of this page. */
export async function writeLongClip(page, path, count, [width, height]) {
  const { BufferTarget, EncodedPacket, EncodedVideoPacketSource, Output, WebMOutputFormat } = createRequire(join(root, 'www/package.json'))(
    'mediabunny',
  );
  const encoded = await page.evaluate(encodedRound, [ROUND, width, height]);
  const packets = encoded.map((base64) => new Uint8Array(Buffer.from(base64, 'base64')));
  const target = new BufferTarget();
  const output = new Output({ format: new WebMOutputFormat(), target });
  const source = new EncodedVideoPacketSource('vp8');
  output.addVideoTrack(source, { frameRate: FRAMES_PER_SECOND });
  await output.start();
  const meta = { decoderConfig: { codec: 'vp8', codedWidth: width, codedHeight: height } };
  for (let k = 0; k < count; k += 1) {
    const kind = k % ROUND === 0 ? 'key' : 'delta';
    await source.add(new EncodedPacket(packets[k % ROUND], kind, k / FRAMES_PER_SECOND, 1 / FRAMES_PER_SECOND), meta);
  }
  await output.finalize();
  writeFileSync(path, new Uint8Array(target.buffer));
}

/** Runs in the page: the packets of one round, as base64. Only the first is a key frame. */
async function encodedRound([count, width, height]) {
  const texture = (side, pitch) => {
    const canvas = new OffscreenCanvas(side, side);
    const context = canvas.getContext('2d');
    for (let y = 0; y < side; y += 4) {
      for (let x = 0; x < side; x += 4) {
        const grey = 128 + 60 * Math.sin(pitch * (0.9 * x + 0.4 * y)) + 50 * Math.cos(pitch * (0.5 * x - 0.8 * y) * 0.61);
        context.fillStyle = `rgb(${grey} ${255 - grey} ${(grey + 128) % 256})`;
        context.fillRect(x, y, 4, 4);
      }
    }
    return canvas;
  };
  const ground = texture(Math.max(width, height), 0.05);
  const radius = Math.round(height / 7);
  const discs = [0.09, 0.13].map((pitch) => {
    const canvas = texture(2 * radius, pitch);
    const context = canvas.getContext('2d');
    context.globalCompositeOperation = 'destination-in';
    context.beginPath();
    context.arc(radius, radius, radius, 0, 2 * Math.PI);
    context.fill();
    return canvas;
  });
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext('2d');
  const packets = [];
  const encoder = new VideoEncoder({
    output: (chunk) => {
      const bytes = new Uint8Array(chunk.byteLength);
      chunk.copyTo(bytes);
      let binary = '';
      for (const byte of bytes) binary += String.fromCharCode(byte);
      packets.push(btoa(binary));
    },
    error: (error) => {
      throw error;
    },
  });
  encoder.configure({ codec: 'vp8', width, height, bitrate: 6e6, framerate: 30 });
  for (let k = 0; k < count; k += 1) {
    context.drawImage(ground, 0, 0);
    for (const [index, disc] of discs.entries()) {
      const angle = (2 * Math.PI * k) / count + index * Math.PI;
      context.drawImage(disc, width * (0.3 + 0.4 * index) + 80 * Math.cos(angle) - radius, height / 2 + 80 * Math.sin(angle) - radius);
    }
    const frame = new VideoFrame(canvas, { timestamp: (k * 1e6) / 30 });
    encoder.encode(frame, { keyFrame: k === 0 });
    frame.close();
    while (encoder.encodeQueueSize > 4) await new Promise((resolve) => setTimeout(resolve, 4));
  }
  await encoder.flush();
  encoder.close();
  return packets;
}
