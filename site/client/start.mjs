// The start page's clip: segmented by the element as its frames arrive, then played.

const demo = document.querySelector('veronese-segmenter');
const play = document.querySelector('.play');
const told = document.querySelector('.told');
const FRAMES_PER_SECOND = 12;
const still = matchMedia('(prefers-reduced-motion: reduce)');

let timer;

if (document.readyState === 'complete') void begin();
else addEventListener('load', () => void begin(), { once: true });

async function begin() {
  const { first, count, frames } = demo.dataset;
  const names = Array.from({ length: Number(count) }, (_, index) => new URL(`${frames}/${String(Number(first) + index).padStart(2, '0')}.webp`, document.baseURI).href);
  const started = performance.now();
  demo.addEventListener('progress', ({ detail: { stage, frame } }) => {
    if (frame !== undefined) told.textContent = `${stage === 'labels' ? 'Masks of' : 'Looking at'} frame ${frame + 1} of ${names.length}`;
  });
  demo.addEventListener('frame', () => (demo.currentFrame = demo.frameCount - 1));
  demo.addEventListener('tracks', ({ detail }) => {
    const seconds = ((performance.now() - started) / 1000).toFixed(1);
    told.textContent = `${names.length} frames, ${detail.objects.length} things that move, ${seconds} seconds in this tab. Click one; step with ← and →.`;
    play.hidden = false;
    if (!still.matches) start();
  });
  const picture = demo.querySelector('img');
  demo.addEventListener('error', ({ detail: { message } }) => {
    failed(message);
    if (demo.frameCount === 0) pictureAlone(picture);
  });
  play.addEventListener('click', () => (timer ? stop() : start()));
  try {
    await import('../package/dist/element.js');
  } catch {
    failed('its script could not be loaded');
    return;
  }
  demo.replaceChildren();
  demo.frames = names;
}

function failed(why) {
  told.textContent = `The clip could not be segmented: ${why}.`;
}

/** An element without a frame would be an empty area. */
function pictureAlone(picture) {
  const place = document.createElement('div');
  place.className = demo.className;
  place.append(picture);
  demo.replaceWith(place);
}

function start() {
  timer = setInterval(() => (demo.currentFrame = (demo.currentFrame + 1) % demo.frameCount), 1000 / FRAMES_PER_SECOND);
  pressed(true);
}

function stop() {
  clearInterval(timer);
  timer = undefined;
  pressed(false);
}

function pressed(playing) {
  play.setAttribute('aria-pressed', String(playing));
  play.textContent = playing ? 'Pause' : 'Play';
}

document.addEventListener('visibilitychange', () => {
  if (document.hidden && timer) stop();
});
