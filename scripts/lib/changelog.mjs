// CHANGELOG.md: its newest section is of the version that is released, and dated.

/** A sentence if the first heading is not `## [X.Y.Z] – YYYY-MM-DD`. */
export function changelogProblem(text, version) {
  const heading = /^## .*$/m.exec(text)?.[0] ?? 'no section';
  const date = new RegExp(`^## \\[?${version.replaceAll('.', '\\.')}\\]? +[–-] +(\\d{4}-\\d\\d-\\d\\d)$`).exec(heading)?.[1];
  // The day must be one of the calendar.
  const isDay = date !== undefined && new Date(`${date}T00:00:00Z`).toJSON()?.startsWith(date);
  return isDay ? undefined : `CHANGELOG.md begins with '${heading}': a release takes \`## [${version}] – YYYY-MM-DD\`.`;
}
