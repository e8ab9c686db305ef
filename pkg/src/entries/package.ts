// The exports of an entry, made for the place where it runs.

// First in the file as well, where gzip packs it best: measured, 1 % of the whole.
import { glue } from '../module/glue.js';
import { glue as pointsGlue } from '../module/glue-points.js';
import type { Clip, ClipFrames, ClipJournal, ClipStream, OpenOptions, StreamOptions, StreamSource } from '../../types/index.js';
import { Api } from '../calls/api.js';
import { pictures } from '../calls/places.js';
import type { Home } from '../calls/session/clip.js';
import { openedClip } from '../calls/session/open.js';
import { streamOf } from '../calls/stream.js';
import { VeroneseError } from '../common/errors.js';
import { Core } from '../module/core.js';
import type { Read } from '../module/loading.js';
import { type Host, segmenters } from '../pool/segmenter.js';

export { groupLabels } from '../calls/labels.js';
export { version } from '../calls/version.js';
export { VeroneseError } from '../common/errors.js';
export { davisPalette } from '../common/palette.js';

/** The differences between the entries. Addresses are seen from `dist`, where all entries lie side by side. */
interface Entry extends Partial<Pick<Host, 'worker' | 'jobs' | 'places' | 'journal'>> {
  read?: Read;
  /** Where the core module lies by default. */
  frames?: URL;
  /** The same for the module of measurements. */
  points?: URL;
}

/** Without an address the caller has to name the module, without `worker` to make the workers. */
export function packageFor({
  read = (place) => fetch(place),
  frames,
  points,
  worker = noWorker,
  jobs = processors,
  places = pictures,
  journal = storedJournal,
}: Entry) {
  const newCore = () => new Core(glue, read, frames);
  const newPoints = () => new Core(pointsGlue, read, points);
  const api = new Api(newCore(), newPoints());
  const here = (): Home => ({ perform: api.perform, size: 1, release: () => undefined });
  // Not of `Api`: workers have that, and none of the code that takes frames to them.
  const openClip = (given: ClipFrames, options?: OpenOptions): Promise<Clip> => openedClip(given, options, here, { places, journal });
  const segmentStream = (given: StreamSource, options?: StreamOptions): ClipStream => streamOf(given, options, here, places);
  return {
    ...api,
    segmentPair: places.pair(api.segmentPair),
    solvePair: places.pair(api.solvePair),
    openClip,
    segmentStream,
    ...segmenters({ newCore, newPoints, worker, jobs, places, journal }),
  };
}

/** In the storage of the page's origin. */
async function storedJournal(name: string): Promise<ClipJournal> {
  return (await import('../calls/session/stored-journal.js')).openStored(name);
}

function noWorker(): never {
  throw new VeroneseError('invalid-option', "option 'worker' is needed here: a function that makes a worker of veronese/worker");
}

function processors(): number {
  return globalThis.navigator?.hardwareConcurrency ?? 1;
}
