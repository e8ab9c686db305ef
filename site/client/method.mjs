// Starts each figure when it comes near the screen.

const figures = document.querySelectorAll('figure[data-figure]');

/** Figures that are only passed on the way to another one are not worth computing. Milliseconds. */
const STAYS = 200;
const coming = new Map();

const near = new IntersectionObserver(
  (entries) => {
    for (const { isIntersecting, target } of entries) {
      clearTimeout(coming.get(target));
      if (isIntersecting) coming.set(target, setTimeout(begin, STAYS, target));
    }
  },
  { rootMargin: '400px' },
);
figures.forEach((figure) => near.observe(figure));

// A formula that is wider than the page scrolls, so the keyboard must reach it.
const wide = new ResizeObserver((entries) => {
  for (const { target } of entries) target.tabIndex = target.scrollWidth > target.clientWidth ? 0 : -1;
});
document.querySelectorAll('math[display="block"]').forEach((formula) => wide.observe(formula));

// A reader who came by a link stays at its target while figures above it grow, until the first movement of their own.
let goal;
const aim = () => (goal = document.getElementById(location.hash.slice(1)));
aim();
addEventListener('hashchange', aim);
for (const kind of ['wheel', 'touchstart', 'pointerdown', 'keydown']) addEventListener(kind, () => (goal = undefined), { passive: true });

function begin(figure) {
  near.unobserve(figure);
  void start(figure);
}

async function start(figure) {
  // As an address, so that the bundler leaves it alone: each figure is a file of its own.
  const script = new URL(`./figures/${figure.dataset.figure}.js`, import.meta.url).href;
  const stage = figure.querySelector('.stage');
  const waiting = stage.querySelector('.waiting');
  try {
    const { default: mount } = await import(script);
    await mount({ stage, say: speaker(figure.querySelector('.reading')) });
    waiting.remove();
    figure.dataset.ready = '';
  } catch (thrown) {
    waiting.textContent = `This figure cannot be computed here: ${thrown.message}`;
    figure.dataset.failed = '';
  }
  goal?.scrollIntoView({ behavior: 'instant' });
}

/** Says in words what a figure shows, once it has come to rest. */
function speaker(reading) {
  let timer;
  return (text) => {
    clearTimeout(timer);
    timer = setTimeout(() => (reading.textContent = text), reading.textContent ? 400 : 0);
  };
}
