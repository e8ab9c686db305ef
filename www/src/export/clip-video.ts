//! Clips as videos of their objects: cut out, before a green screen, or as a matte. They are encoded by the browser, so the formats that are
//! offered depend on it.

import { PageError } from '../common/errors.js';
import { strings } from '../common/strings.js';
import type { ClipExport, ClipFormat } from './clip-export.js';
import { type Ground, drawn } from './cut-out.js';
import { H264, VP9, encodes } from './video-codecs.js';

const KINDS: readonly (Pick<ClipFormat, 'id' | 'title' | 'hint'> & { readonly ground: Ground })[] = [
  { id: 'video-transparent', title: 'Video, transparent', hint: 'The objects cut out of the picture: WebM, VP9 with alpha.', ground: 'transparent' },
  { id: 'video-green', title: 'Video, green screen', hint: 'The objects before pure green, for editors that do not read transparent WebM.', ground: 'green' },
  { id: 'video-matte', title: 'Video, matte', hint: 'White objects before black: a luma matte for the clip.', ground: 'black' },
];

/** The formats that this browser can write, in the order of the menu. */
export async function videoFormats(): Promise<ClipFormat[]> {
  const [vp9, h264] = await Promise.all([encodes(VP9), encodes(H264)]);
  return KINDS.flatMap(({ ground, ...kind }) => {
    const codec = h264 && ground !== 'transparent' ? H264 : vp9 ? VP9 : null;
    if (codec === null) return [];
    const nameOf = ({ meta }: ClipExport): string => `${meta.clip}-${kind.id.replace('video-', '')}.${codec === H264 ? 'mp4' : 'webm'}`;
    return {
      ...kind,
      names: (exported) => [nameOf(exported)],
      make: async (exported) => ({ [nameOf(exported)]: await (await import('./video-file.js')).videoOf(exported, ground, codec) }),
      picture: async (exported) => {
        for await (const frame of exported.frames()) return (await drawn(exported, frame, ground)).convertToBlob();
        throw new PageError('no-masks', strings.preview.noMasks);
      },
    };
  });
}
