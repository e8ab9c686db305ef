// What `npm start` says at its end: where the page is, and what to do with one's own frames.

const OWN = `Your own frames, or a video:
  node pkg/bin/veronese.js clip your-folder --out masks
  node pkg/bin/veronese.js help`;

/** `page`: where it is served, if it is. `env` tells of a connection by SSH, whose browser is on another computer. */
export function nextSteps(page, env = process.env) {
  if (!page) return `The page: npm start\n\n${OWN}`;
  const { host, port } = page;
  const isHere = host === '127.0.0.1';
  const lines = [`The page is at http://${isHere ? 'localhost' : host}:${port}/ (Ctrl-C ends it)`];
  const [, , server] = env.SSH_CONNECTION?.split(' ') ?? [];
  if (server && isHere)
    lines.push(`From where you sit: ssh -L ${port}:localhost:${port} ${env.USER ?? 'you'}@${server}, then the same address`);
  else if (server) lines.push(`From where you sit: http://${server.includes(':') ? `[${server}]` : server}:${port}/`);
  return `${lines.join('\n')}\n\n${OWN}`;
}
