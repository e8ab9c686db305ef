//! The codecs of the videos that browsers write.

import { startMedia } from '../common/media.js';

/** VP9, the only codec that they encode with transparency; and H.264, which editors read. Of the levels for frames up to 4096 × 2176. */
export const VP9 = 'vp09.00.51.08';
export const H264 = 'avc1.640033';

export async function encodes(codec: string): Promise<boolean> {
  if (typeof VideoEncoder !== 'function') return false;
  startMedia();
  const { supported } = await VideoEncoder.isConfigSupported({ codec, width: 1280, height: 720 }).catch(() => ({ supported: false }));
  return supported === true;
}
