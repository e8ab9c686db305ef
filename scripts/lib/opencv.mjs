// Programs in Python that use OpenCV: what the benchmarks compare with.

import { must, run } from './run.mjs';

/** Number of programs that run at once. */
const AT_ONCE = 2;

/** The first Python that has NumPy and OpenCV; says what is missing and returns undefined if there is none. */
export async function findOpenCv() {
  const candidates = process.env.VERONESE_PYTHON ? [process.env.VERONESE_PYTHON] : ['python3', 'python'];
  for (const python of candidates) {
    if ((await run(python, ['-c', 'import cv2, numpy'], { output: 'collect' })).code === 0) return python;
  }
  const packages = 'pip install numpy opencv-python-headless';
  console.error(`Without a baseline to compare with: it needs Python with NumPy and OpenCV (${packages}). The Python to take may`);
  console.error('be named in VERONESE_PYTHON; otherwise python3, then python on the path are tried.');
  return undefined;
}

/** Runs a program on every case (its name, its folder), with the arguments that `argumentsOf` gives. */
export async function runOnAll(python, program, cases, argumentsOf) {
  console.error(`The baseline on ${cases.length} cases, by ${python} …`);
  const left = [...cases];
  const worker = async () => {
    for (let next = left.shift(); next; next = left.shift()) {
      const [name, folder] = next;
      await must(`The baseline failed on ${name}.`, python, [program, ...argumentsOf(name, folder)], { output: 'collect' });
    }
  };
  await Promise.all(Array.from({ length: AT_ONCE }, worker));
}
