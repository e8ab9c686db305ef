// npm run notices: writes THIRD-PARTY-NOTICES. With --check it only compares.

import { noticesProblem, writeNotices } from './lib/notices.mjs';
import { command } from './lib/run.mjs';

await command(async () => {
  if (!process.argv.includes('--check')) await writeNotices();
  const problem = await noticesProblem();
  if (problem) console.error(problem);
  return problem ? 1 : 0;
});
