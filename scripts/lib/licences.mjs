// Which licences and sources of crates are allowed stands in deny.toml. cargo-deny takes minutes to compile, so it is used where it is
// installed. The workflows install it and set the variable, so that there the check cannot be left out unseen.

import { run, say } from './run.mjs';

const REQUIRED = 'VERONESE_REQUIRE_CARGO_DENY';

/** `{ allowed }`, or `{ skipped }` with a sentence where cargo-deny is not installed and not required. */
export async function licencesAllowed() {
  const { code } = await run('cargo', ['deny', '--version'], { output: 'collect' });
  if (code !== 0 && !process.env[REQUIRED]) {
    return {
      skipped: 'Licences, bans and sources of crates were not checked: cargo-deny is not installed (`cargo install --locked cargo-deny`).',
    };
  }
  const args = ['deny', '--all-features', 'check', 'licenses', 'bans', 'sources'];
  say(`\n— licences, bans and sources of crates: cargo ${args.join(' ')}`);
  return { allowed: (await run('cargo', args)).code === 0 };
}
