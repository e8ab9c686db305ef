//! Opens a video with the most exact reader that the browser supports.

import { PageError } from '../common/errors.js';
import { startMedia } from '../common/media.js';
import { quoted } from '../common/shell.js';
import { strings } from '../common/strings.js';
import { fingerprintOfVideo } from '../frames/fingerprints.js';
import { openApproximate } from './approximate.js';
import type { Clip } from './clip.js';

/**
 * Opens a video: with exact frames if the browser has WebCodecs and the codec, else by seeking, and `exact` of the clip is false. Throws a
 * {@link PageError} if neither works: `unsupported-codec` if the browser lacks the codec, else `unreadable-video`.
 */
export async function openClip(file: File): Promise<Clip> {
  const fingerprint = await fingerprintOfVideo(file).catch(() => {
    throw new PageError('unreadable-video', strings.errors.unreadableVideo(file.name));
  });
  if (typeof VideoDecoder === 'function') {
    startMedia();
    const { openExact } = await import('./exact.js');
    const clip = await openExact(file, fingerprint);
    if (clip !== null) return clip;
  }
  const clip = await openApproximate(file, fingerprint);
  if (clip !== null) return clip;
  const { undecodable } = await import('./exact.js');
  const codec = await undecodable(file);
  if (codec === null) throw new PageError('unreadable-video', strings.errors.unreadableVideo(file.name));
  throw new PageError('unsupported-codec', strings.errors.unsupportedCodec(file.name, codec, conversion(file.name)));
}

/** The command that converts a video to one that every browser plays. Some browsers play only 8 bits per sample. */
function conversion(name: string): string {
  const output = `${name.replace(/\.[^.]*$/, '')}-h264.mp4`;
  return `ffmpeg -i ${quoted(name)} -c:v libx264 -pix_fmt yuv420p ${quoted(output)}`;
}
