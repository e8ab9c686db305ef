// Installs Label Studio from PyPI in its own environment and drives it for the proof.

import { spawn } from 'node:child_process';
import { createWriteStream, existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { basename, dirname, extname, join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';

import { launchChromium } from './launch-chromium.mjs';
import { toolsFolder, which } from './project.mjs';
import { Stop, longStep, run } from './run.mjs';

const VERSION = '1.23.2';
const VENV = join(toolsFolder, 'label-studio');
const USER = { email: 'proof@example.com', password: 'only-for-the-proof', token: '0123456789abcdef0123456789abcdef01234567' };
/** The first start creates the database, which takes minutes on a slow machine. */
const PATIENCE = 600_000;

/** Installs Label Studio unless it is installed. */
export async function prepareLabelStudio() {
  const pip = join(VENV, 'bin', 'pip');
  if (existsSync(pip) && (await run(pip, ['show', 'label-studio'], { output: 'collect' })).stdout.includes(`Version: ${VERSION}`)) return;
  // Anew: programs of an environment that was moved name a Python that is not there.
  if (!which('python3')) throw new Stop('Label Studio needs Python: install python3 with its venv module.');
  await longStep('Making a Python environment', 'It could not be made: install the venv module (Debian: `apt-get install python3-venv`).', 'python3', ['-m', 'venv', '--clear', VENV]);
  await longStep('Installing Label Studio (some minutes)', 'Label Studio could not be installed.', pip, ['install', '--quiet', `label-studio==${VERSION}`]);
}

/** Starts it on loopback with a new database in `folder`; `stop()` ends it. */
export async function startLabelStudio(folder, port) {
  mkdirSync(folder, { recursive: true });
  const address = `http://127.0.0.1:${port}`;
  const env = {
    ...process.env,
    LABEL_STUDIO_BASE_DATA_DIR: folder,
    LABEL_STUDIO_ENABLE_LEGACY_API_TOKEN: 'true',
    // The address that it reports at set-up.
    LABEL_STUDIO_HOST: address,
    // The backend and the frames are on this computer. A public instance must refuse such addresses.
    ML_BLOCK_LOCAL_IP: 'false',
    SSRF_PROTECTION_ENABLED: 'false',
    COLLECT_ANALYTICS: 'false',
    LATEST_VERSION_CHECK: 'false',
  };
  const args = ['start', '--no-browser', '--internal-host', '127.0.0.1', '--port', String(port)];
  const user = ['--username', USER.email, '--password', USER.password, '--user-token', USER.token];
  const child = spawn(join(VENV, 'bin', 'label-studio'), [...args, ...user], { env, stdio: ['ignore', 'pipe', 'pipe'] });
  const log = createWriteStream(join(folder, 'log.txt'));
  child.stdout.pipe(log);
  child.stderr.pipe(log);
  const studio = { address, ...USER, stop: () => child.kill() };
  const since = Date.now();
  while (!(await fetch(`${address}/health`).then(({ ok }) => ok, () => false))) {
    if (child.exitCode !== null) throw new Stop(`Label Studio ended with code ${child.exitCode}; it said:\n${readFileSync(join(folder, 'log.txt'))}`);
    if (Date.now() - since > PATIENCE) {
      studio.stop();
      throw new Stop('Label Studio did not answer within ten minutes.');
    }
    await sleep(1000);
  }
  return studio;
}

const TYPES = { '.png': 'image/png', '.webm': 'video/webm' };

/** Serves files to Label Studio's page, with the CORS header it needs to read them from a canvas, and in parts, as a player seeks. */
export async function serveFiles(paths) {
  const server = createServer((request, response) => {
    const path = paths[/^\/(\d+)\./.exec(request.url)?.[1]];
    if (!path) return response.writeHead(404).end();
    const content = readFileSync(path);
    const headers = { 'Content-Type': TYPES[extname(path)], 'Access-Control-Allow-Origin': '*', 'Accept-Ranges': 'bytes' };
    const [, from, until] = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '') ?? [];
    if (from === undefined) return response.writeHead(200, headers).end(content);
    const part = content.subarray(Number(from), until ? Number(until) + 1 : undefined);
    const range = `bytes ${from}-${Number(from) + part.length - 1}/${content.length}`;
    return response.writeHead(206, { ...headers, 'Content-Range': range }).end(part);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const origin = `http://127.0.0.1:${server.address().port}`;
  return { origin, addresses: paths.map((path, index) => `${origin}/${index}${extname(path)}`), close: () => server.close() };
}

const CONFIG = `<View>
  <BrushLabels name="moving" toName="first">
    <Label value="moving-1" background="#e6194b"/><Label value="moving-2" background="#3cb44b"/><Label value="moving-3" background="#4363d8"/>
  </BrushLabels>
  <View style="display: flex; gap: 2em">
    <View style="width: 50%"><Image name="first" value="$first"/></View>
    <View style="width: 50%"><Image name="second" value="$second"/></View>
  </View>
</View>`;

const VIDEO_CONFIG = `<View>
  <Labels name="kinds" toName="video"><Label value="moving" background="#e6194b"/><Label value="other" background="#3cb44b"/></Labels>
  <Video name="video" value="$video" frameRate="$fps"/>
  <VideoRectangle name="box" toName="video"/>
</View>`;

/** A function that asks the REST API. */
function apiOf(studio) {
  return async (method, path, body) => {
    const form = body instanceof FormData;
    const headers = { Authorization: `Token ${studio.token}`, ...(!form && { 'Content-Type': 'application/json' }) };
    const response = await fetch(`${studio.address}/api/${path}`, { method, headers, ...(body && { body: form ? body : JSON.stringify(body) }) });
    const text = await response.text();
    if (!response.ok) throw new Stop(`${method} /api/${path} answered ${response.status}: ${text.slice(0, 2000)}`);
    return text === '' ? undefined : JSON.parse(text);
  };
}

/**
 * Uses the REST API to create a project, our backend, a task with two linked frames and one with two uploaded files, and predictions.
 * Returns the stored predictions of each task.
 */
export async function predictions(studio, backend, linked, files) {
  const api = apiOf(studio);
  const project = await api('POST', 'projects', { title: 'What moves', show_collab_predictions: true });
  const uploaded = [];
  for (const path of files) {
    const form = new FormData();
    form.append('file', new Blob([readFileSync(path)], { type: 'image/png' }), basename(path));
    const { file_upload_ids: [id] } = await api('POST', `projects/${project.id}/import?commit_to_project=false`, form);
    uploaded.push(`/data/${(await api('GET', `import/file-upload/${id}`)).file}`);
  }
  // Only now, because a configuration with two images does not accept uploads.
  await api('PATCH', `projects/${project.id}`, { label_config: CONFIG });
  return predicted(api, backend, project.id, [linked, uploaded].map(([first, second]) => ({ first, second })));
}

/** The same with a project whose task is a linked video. */
export async function videoPredictions(studio, backend, video, fps) {
  const api = apiOf(studio);
  const project = await api('POST', 'projects', { title: 'What moves in a clip', show_collab_predictions: true, label_config: VIDEO_CONFIG });
  return predicted(api, backend, project.id, [{ video, fps }]);
}

/** Connects our backend to a project, creates tasks, and has Label Studio ask for their predictions. */
async function predicted(api, backend, project, all) {
  const connection = await api('POST', 'ml', { url: backend, project, title: 'Veronese' });
  for (const data of all) await api('POST', `projects/${project}/import?return_task_ids=true`, [{ data }]);
  const { tasks } = await api('GET', `tasks?project=${project}`);
  const selectedItems = { all: false, included: tasks.map(({ id }) => id) };
  await api('POST', `dm/actions?id=retrieve_tasks_predictions&project=${project}`, { selectedItems, ordering: [] });
  const found = await Promise.all(tasks.map(({ id }) => api('GET', `predictions?task=${id}`)));
  await api('PATCH', `projects/${project}`, { model_version: found[0][0]?.model_version });
  return { project, task: tasks[0].id, state: connection.state ?? connection.readable_state, found };
}

/** Pixels of a stored brush, decoded by Label Studio's own library: one byte each, 0 or 255. */
export async function decodedByStudio(rle) {
  const program = 'import json,sys; from label_studio_sdk.converter.brush import decode_rle; print(json.dumps(decode_rle(json.loads(sys.argv[1])).tolist()[3::4]))';
  const { code, stdout, text } = await run(join(VENV, 'bin', 'python'), ['-c', program, JSON.stringify(rle)], { output: 'collect' });
  if (code !== 0) throw new Stop(`The studio's library could not decode a mask:\n${text}`);
  return JSON.parse(stdout);
}

/** Signs in through the page and takes a screenshot of the task with its masks or boxes; returns the text and the rectangles that it shows. */
export async function picture(studio, { project, task }, chromiumPath, file) {
  const browser = await launchChromium(chromiumPath);
  try {
    const page = await browser.newPage({ viewport: { width: 1600, height: 900 } });
    await page.goto(`${studio.address}/user/login/`);
    await page.fill('input[name=email]', studio.email);
    await page.fill('input[name=password]', studio.password);
    await Promise.all([page.waitForURL((url) => !url.pathname.includes('login')), page.click('button[type=submit]')]);
    await page.goto(`${studio.address}/projects/${project}/data?task=${task}`);
    await page.waitForSelector('.konvajs-content canvas', { timeout: 120_000 });
    // The masks are painted after the frames.
    await page.waitForLoadState('networkidle').catch(() => undefined);
    await sleep(3000);
    mkdirSync(dirname(file), { recursive: true });
    await page.screenshot({ path: file });
    return await page.evaluate(() => {
      // Konva, with which Label Studio draws over pictures and videos, keeps its stages.
      const nodes = (globalThis.Konva?.stages ?? []).flatMap((stage) => stage.find('Rect'));
      const rectangles = nodes.map((node) => [node.x(), node.y(), node.width() * node.scaleX(), node.height() * node.scaleY()]);
      return { text: document.body.innerText, rectangles };
    });
  } finally {
    await browser.close();
  }
}
