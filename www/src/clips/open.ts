//! Opens a video, or says why this browser cannot.

import { PageError } from '../common/errors.js';
import { startMedia } from '../common/media.js';
import { quoted } from '../common/shell.js';
import { strings } from '../common/strings.js';
import { fingerprintOfVideo } from '../frames/fingerprints.js';
import type { Clip } from './clip.js';

/**
 * Opens a video, whose frames are exact. Throws a {@link PageError}: `unsupported-codec` if the browser has no decoder for it, else
 * `unreadable-video`.
 */
export async function openClip(file: File): Promise<Clip> {
  const unreadable = (): PageError => new PageError('unreadable-video', strings.errors.unreadableVideo(file.name));
  const fingerprint = await fingerprintOfVideo(file).catch(() => {
    throw unreadable();
  });
  startMedia();
  const { openExact, undecodable } = await import('./exact.js');
  const clip = await openExact(file, fingerprint);
  if (clip !== null) return clip;
  const codec = await undecodable(file);
  if (codec === null) throw unreadable();
  throw new PageError('unsupported-codec', strings.errors.unsupportedCodec(file.name, codec, conversion(file.name)));
}

/** The command that converts a video to one that every browser plays. Some browsers play only 8 bits per sample. */
function conversion(name: string): string {
  const output = `${name.replace(/\.[^.]*$/, '')}-h264.mp4`;
  return `ffmpeg -i ${quoted(name)} -c:v libx264 -pix_fmt yuv420p ${quoted(output)}`;
}
